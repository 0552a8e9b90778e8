// Hands of other programs, and several hands on one scene. Nothing here depends on how fast the
// machine is: what is waited for comes, or the test fails after two minutes. A client that is
// starved of its processor is read seldom and feels a softer surface (HandRhythm), so a press is
// judged by a force that a client at 20 Hz feels, too.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <thread>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "device/remote_client.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/remote.hpp"
#include "support/contains.hpp"

namespace palpate::app {
namespace {

using test::contains;

constexpr double kAbove = 5e-3;  // m over where the device stands

constexpr double kFelt = 0.05;        // N
constexpr double kFeltTorque = 1e-3;  // N m

// Every millisecond or so, until it is true.
bool until(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

// A client's hand is at z, m, until it is heard: there the contact begins.
bool arrives(test::RemoteClient& client, double z) {
  return until([&] {
    client.say(z);
    const auto heard = client.hear();
    return heard && (heard->flags & 1) != 0;
  });
}

// A client's hand presses down to z, m, again and again (one that rests is given no energy, so that
// its force does not grow while the device starts softly), until it feels more than kFelt.
bool presses_and_feels(test::RemoteClient& client, double z) {
  double felt = 0;
  int step = 0;
  return until([&] {
    client.say(kAbove + 0.5 * (z - kAbove) * (1 - std::cos(1e-2 * ++step)));
    felt = client.hear().value_or(test::RemoteClient::Heard{0, felt}).z;
    return felt > kFelt;
  });
}

// The plane's points are in the middle under the device's origin, 2 mm below it.
TEST(HandsProgram, AnotherProgramsHandFeelsTheSurface) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const auto run = shell.start(
      "touch plane.xyz --scale 2 --viewpoint 0,0,1 --stiffness 500 --device remote:hand --json "
      "run.json "
      "--log "
      "forces.csv");
  ASSERT_TRUE(until([&] { return contains(shell.read("stderr"), "hand 1: listening on hand"); }));
  test::RemoteClient client(shell.path("hand"), shell.path("client"));
  EXPECT_TRUE(arrives(client, kAbove));
  EXPECT_TRUE(presses_and_feels(client, -4e-3)) << "up to 2 mm deep, 1 N";
  EXPECT_EQ(run->interrupt(), 0) << shell.read("stderr");
  const Json report = Json::parse(shell.read("run.json"));
  EXPECT_EQ(report["device"]["name"], "remote");
  EXPECT_EQ(report["device"]["scale"], 1);
  EXPECT_GT(report["device"]["packets_taken"], 10);
  EXPECT_NEAR(report["device"]["origin_m"][2], 2e-3, 2e-4);
  EXPECT_GT(report["largest_force_N"], kFelt);
  EXPECT_LT(report["largest_force_N"], 1.1);
  EXPECT_EQ(report["live"]["guard"]["faults"], 0);
  EXPECT_EQ(columns(shell.read("forces.csv"))["fz"].size(), report["steps"]);
}

// A tilted box that is pressed on the plane turns the hand back, as far as the profile's motors do.
TEST(HandsProgram, AnotherProgramsWristFeelsTheTorque) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("wrist.toml", "[wrist]\nmaximum_force = 10\nmaximum_torque = 0.02\n");
  const auto run = shell.start(
      "touch plane.xyz --scale 2 --viewpoint 0,0,1 --stiffness 500 --tool box:20x30x10 --device "
      "remote:hand,profile=wrist.toml");
  ASSERT_TRUE(until([&] { return contains(shell.read("stderr"), "hand 1: listening on hand"); }));
  test::RemoteClient client(shell.path("hand"), shell.path("client"));
  client.packet().version = RemoteVersion::kTurns;
  client.packet().turns.renders_torque = true;
  client.packet().turns.orientation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  EXPECT_TRUE(arrives(client, 30e-3));
  double most = 0;
  int step = 0;
  EXPECT_TRUE(until([&] {
    client.say(30e-3 - 20e-3 * (1 - std::cos(1e-2 * ++step)));
    const auto heard = client.hear();
    if (heard) most = std::max(most, -heard->torque.y());
    return most > kFeltTorque;
  })) << most;
  EXPECT_LE(most, 0.016 + 1e-12) << "0.8 of what it holds";
  EXPECT_EQ(run->interrupt(), 0) << shell.read("stderr");
}

// The force that a hand gets at most is what its profile says, or else what the run is told.
TEST(HandsProgram, AProfileThatSaysNoForceLeavesItToTheOption) {
  const struct {
    const char* profile;
    double most;
  } cases[] = {{"[wrist]\nmaximum_torque = 0.02\n", 8},
               {"[wrist]\nmaximum_torque = 0.02\nmaximum_force = 5\n", 4}};
  for (const auto& each : cases) {
    Shell shell;
    shell.write("plane.xyz", plane_xyz());
    shell.write("wrist.toml", each.profile);
    const auto run = shell.start(
        "touch plane.xyz --device remote:hand,profile=wrist.toml --maximum-force 8 --json "
        "run.json");
    ASSERT_TRUE(until([&] { return contains(shell.read("stderr"), "hand 1: listening on hand"); }));
    test::RemoteClient client(shell.path("hand"), shell.path("client"));
    EXPECT_TRUE(arrives(client, kAbove));
    EXPECT_EQ(run->interrupt(), 0) << shell.read("stderr");
    const Json report = Json::parse(shell.read("run.json"));
    EXPECT_EQ(report["live"]["guard"]["maximum_force_N"], each.most) << each.profile;
  }
}

TEST(HandsProgram, AClosedTerminalEndsARunAsCtrlCDoes) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const auto run = shell.start("touch plane.xyz --device remote:hand --log steps.csv");
  ASSERT_TRUE(until([&] { return contains(shell.read("stderr"), "hand 1: listening on hand"); }));
  test::RemoteClient client(shell.path("hand"), shell.path("client"));
  EXPECT_TRUE(arrives(client, kAbove));
  EXPECT_EQ(run->interrupt(SIGHUP), 0) << shell.read("stderr");
  EXPECT_GT(columns(shell.read("steps.csv"))["fz"].size(), 0U);
}

// It presses the tool into the plane, goes up with the clutch held, and feels the plane there.
TEST(HandsProgram, AClutchTakesTheSurfaceToTheHand) {
  constexpr double kHigh = 50e-3;
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const auto run = shell.start(
      "touch plane.xyz --scale 2 --viewpoint 0,0,1 --stiffness 500 --json run.json --device "
      "remote:hand,clutch=2,offset=0/0/0.001");
  ASSERT_TRUE(until([&] { return contains(shell.read("stderr"), "hand 1: listening on hand"); }));
  test::RemoteClient client(shell.path("hand"), shell.path("client"));
  EXPECT_TRUE(arrives(client, kAbove));
  EXPECT_TRUE(presses_and_feels(client, -5e-3)) << "up to 2 mm deep, 1 N";
  client.packet().buttons = 1u << 2;
  const auto felt_at = [&](double z, auto good) {
    return until([&] {
      client.say(z);
      const auto heard = client.hear();
      return heard && good(heard->z);
    });
  };
  EXPECT_TRUE(felt_at(-5e-3, [](double force) { return force == 0; })) << "pressed all the same";
  EXPECT_TRUE(felt_at(kHigh, [](double force) { return force == 0; }));
  EXPECT_TRUE(until([&] {
    client.say(kHigh);
    return contains(shell.read("stderr"), "clutch held: the hand moves without the tool");
  }));
  client.packet().buttons = 0;
  int step = 0;
  EXPECT_TRUE(until([&] {
    client.say(kHigh - 1.5e-3 * (1 - std::cos(1e-2 * ++step)));
    return client.hear().value_or(test::RemoteClient::Heard{0, 0}).z > kFelt;
  }));
  EXPECT_EQ(run->interrupt(), 0) << shell.read("stderr");
  const Json report = Json::parse(shell.read("run.json"));
  EXPECT_EQ(report["device"]["clutch_button"], 2);
  EXPECT_NEAR(report["device"]["origin_m"][2], 3e-3, 2e-4);
  EXPECT_LT(report["energy_given_to_hand_J"], 1e-5);
}

TEST(HandsProgram, ASilentDeviceSaysWhyAndEndsWithTheDuration) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const Outcome outcome = shell.run("touch plane.xyz --device remote:hand --duration 3");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, " s  no client is sending to 'hand'; start one"))
      << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "never touched the surface: no client is sending"))
      << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "remote device")) << outcome.out;
}

TEST(HandsProgram, WhereASocketCannotBeIsSaidBeforeTheCloudIsRead) {
  Shell shell;
  shell.write("file", "");
  const Outcome kind = shell.run("touch missing.ply --device remote:file,profile=spoon");
  EXPECT_TRUE(contains(kind.err, "unknown device profile 'spoon'")) << kind.err;
  const Outcome file = shell.run("touch missing.ply --device remote:file");
  EXPECT_EQ(file.code, 1);
  EXPECT_TRUE(contains(file.err, "not a socket")) << file.err;
  const SteadyClock clock;
  const RemoteDevice other(clock, {.path = shell.path("taken")});
  const Outcome taken = shell.run("touch missing.ply --device remote:taken");
  EXPECT_EQ(taken.code, 1);
  EXPECT_TRUE(contains(taken.err, "another program is listening there")) << taken.err;
  const Outcome nowhere = shell.run("touch missing.ply --device remote", "", "XDG_RUNTIME_DIR=");
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_TRUE(contains(nowhere.err, "XDG_RUNTIME_DIR is not set")) << nowhere.err;
  EXPECT_TRUE(contains(nowhere.err, "--device remote:/tmp/hand")) << nowhere.err;
}

TEST(HandsProgram, EachOfSeveralHandsHasItsLogAndItsPartOfTheReport) {
  Shell shell;
  const Outcome outcome = shell.run(
      "touch synthetic:sphere --device simulated --device scripted --duration 1 --log forces.csv "
      "--json run.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "hand 1 balanced field")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "hand 2 balanced field")) << outcome.out;
  const Json report = Json::parse(shell.read("run.json"));
  EXPECT_FALSE(report.contains("steps")) << "of a hand each";
  ASSERT_EQ(report["hands"].size(), 2u);
  EXPECT_EQ(report["hands"][0]["device"]["name"], "simulated");
  EXPECT_EQ(report["hands"][1]["device"]["name"], "scripted");
  const auto one = columns(shell.read("forces.csv"));
  const auto two = columns(shell.read("forces-2.csv"));
  EXPECT_EQ(one.at("t").size(), report["hands"][0]["steps"]);
  EXPECT_EQ(two.at("t").size(), report["hands"][1]["steps"]);
  EXPECT_NE(one.at("hip_x").front(), two.at("hip_x").front()) << "they explore other places";
}

TEST(HandsProgram, AHandThatIsLedTouchesBesideAnotherPrograms) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const auto run = shell.start(
      "touch plane.xyz --scale 2 --viewpoint 0,0,1 --trajectory way.csv --device scripted --device "
      "remote:hand --json run.json");
  ASSERT_TRUE(until([&] { return contains(shell.read("stderr"), "hand 2: listening on hand"); }));
  test::RemoteClient client(shell.path("hand"), shell.path("client"));
  EXPECT_TRUE(arrives(client, kAbove));
  EXPECT_TRUE(presses_and_feels(client, -4e-3));
  EXPECT_EQ(run->interrupt(), 0) << shell.read("stderr");
  const Json hands = Json::parse(shell.read("run.json"))["hands"];
  EXPECT_EQ(hands[0]["contacts"], 1);
  EXPECT_GT(hands[1]["largest_force_N"], kFelt);
}

TEST(HandsProgram, ADemoHasAsManyHandsAsItIsAskedFor) {
  Shell shell;
  const Outcome outcome = shell.run(
      "demo scan --headless --port 0 --duration 3 --device simulated --device remote:hand");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "| hand 2: no client is sending to 'hand'")) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "hand 1 ")) << outcome.out;
}

TEST(HandsProgram, RefusesDevicesThatCannotBeOrHaveNoUse) {
  Shell shell;
  shell.write("way.csv", press_and_slide());
  const std::string touch = "touch synthetic:torus ";
  const std::pair<const char*, const char*> cases[] = {
      {"--device falcon", "scripted, simulated, remote"},
      {"--device remote:", "remote:PATH"},
      {"--device remote,frame=camera", "no source is a camera"},
      {"--device remote,frame=torus", "a cloud"},
      {"--device remote,clutch=x", "clutch"},
      {"--device scripted,scale=2", "works only with simulated"},
      {"--device remote --trajectory way.csv", "--trajectory applies only to scripted"},
      {"--device remote --seed 2", "--seed"},
      {"--device remote --simulated-time", "real time"},
      {"--device simulated --device simulated --simulated-time", "real time"},
      {"--device simulated --device scripted --trajectory way.csv", "only one device"},
      {"--device remote --device remote", "the default path"},
      {"--device remote:a --device remote:a", "'a'"},
      {"--device simulated --device simulated --log -", "standard output"},
      {"--device simulated --device simulated --log a.csv --json a-2.csv", "same file"},
      {"--device scripted --device scripted --device scripted --device scripted --device scripted",
       "four hands"},
  };
  for (const auto& [arguments, word] : cases) {
    const Outcome outcome = shell.run(touch + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(contains(outcome.err, word)) << arguments << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace palpate::app
