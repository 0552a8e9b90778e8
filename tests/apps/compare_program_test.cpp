#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/program.hpp"
#include "base/numbers.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/analytic.hpp"

namespace palpate::app {
namespace {

using Eigen::Vector3d;

nlohmann::json compared(Shell& shell, const std::string& arguments) {
  const Outcome outcome = shell.run("touch " + arguments + " --compare --json report.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("compared"), std::string::npos);
  return nlohmann::json::parse(shell.read("report.json"))["compared"];
}

TEST(Compare, OfItsOwnLogIsZero) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const std::string feel = "plane.xyz --stiffness 400 --friction-dynamic 0.2 ";
  ASSERT_EQ(shell.run("touch " + feel + "--trajectory way.csv --log log.csv").code, 0);
  const auto same = compared(shell, feel + "--trajectory log.csv");
  EXPECT_GT(same["steps"].get<int>(), 200);
  for (const char* key : {"rms_N", "median_N", "only_measured_share", "only_rendered_share"}) {
    EXPECT_EQ(same[key].get<double>(), 0) << key;
  }
  EXPECT_LT(same["direction_deg"].get<double>(), 1e-6);
}

// A box that is turned while it is pressed on the plane, and one that is pulled over a torus.
TEST(Compare, OfAToolsOwnLogIsZero) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  std::string way = "t,hip_x,hip_y,hip_z,qx,qy,qz,qw\n";
  for (int k = 0; k < 600; ++k) {
    const double half = 0.2 * std::sin(0.01 * k);
    way += fmt::format("{},0,0,{},0,{},0,{}\n", 1e-3 * k, 5e-3 + 4e-3 * std::cos(0.02 * k),
                       std::sin(half), std::cos(half));
  }
  shell.write("way.csv", way);
  const std::string feel = "plane.xyz --tool box:20x30x10 ";
  ASSERT_EQ(shell.run("touch " + feel + "--trajectory way.csv --log log.csv").code, 0);
  EXPECT_NE(shell.read("log.csv").find(",qx,qy,qz,qw"), std::string::npos);
  const auto same = compared(shell, feel + "--trajectory log.csv");
  EXPECT_GT(same["steps"].get<int>(), 200);
  EXPECT_EQ(same["rms_N"].get<double>(), 0);
  const std::string torus = "synthetic:torus --stiffness 500 --tool box:20x30x10 ";
  ASSERT_EQ(shell.run("touch " + torus + "--duration 1 --log log.csv").code, 0);
  EXPECT_EQ(compared(shell, torus + "--trajectory log.csv")["rms_N"].get<double>(), 0);
}

// A gripper that closes on the plane, held by a device whose metre is two of the world.
TEST(Compare, OfAGrippersOwnLogIsZeroWhateverItsDevicesScale) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  std::string way = "t,hip_x,hip_y,hip_z,gripper\n";
  for (int k = 0; k < 600; ++k) {
    way += fmt::format("{},0,0,{},{}\n", 1e-3 * k, 0.04 - 4e-5 * k, 0.02 + 1e-5 * k);
  }
  shell.write("way.csv", way);
  const std::string feel = "plane.xyz --tool gripper:6x12x30 --stiffness 300 ";
  ASSERT_EQ(
      shell.run("touch " + feel + "--trajectory way.csv --device simulated,scale=2 --log log.csv")
          .code,
      0);
  auto log = columns(shell.read("log.csv"));
  EXPECT_NEAR(number(log["gripper"].front()), 0.02, 1e-9);
  EXPECT_NEAR(number(log["tool_opening"].front()), 0.02, 1e-9);
  const auto same = compared(shell, feel + "--trajectory log.csv");
  EXPECT_GT(same["steps"].get<int>(), 100);
  EXPECT_EQ(same["rms_N"].get<double>(), 0);
}

TEST(Compare, OfAnExplorationsLogIsZero) {
  Shell shell;
  ASSERT_EQ(shell.run("touch synthetic:bumps --duration 1 --stiffness 500 --log log.csv").code, 0);
  const auto same = compared(shell, "synthetic:bumps --stiffness 500 --trajectory log.csv");
  EXPECT_GT(same["steps"].get<int>(), 100);
  EXPECT_EQ(same["rms_N"].get<double>(), 0);
}

TEST(Compare, SeesASurfaceThatIsOffByAMillimetre) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  ASSERT_EQ(shell.run("touch plane.xyz --trajectory way.csv --log log.csv").code, 0);
  const auto off = compared(shell, "p=plane.xyz --pose p=0,0,0.001,0,0,0,1 --trajectory log.csv");
  EXPECT_NEAR(off["rms_N"].get<double>(), 0.5, 0.1);
  EXPECT_NEAR(off["median_N"].get<double>(), 0.5, 0.01);
  EXPECT_GT(off["only_rendered_share"].get<double>(), 0.01);
}

TEST(Compare, SaysWhatItNeeds) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const struct {
    const char* arguments;
    int code;
    const char* words;
  } cases[] = {
      {"--trajectory way.csv --compare", 1,
       "way.csv has no columns fx, fy, fz; --compare needs them"},
      {"--compare", 2, "--compare needs --trajectory"},
      {"--trajectory way.csv --device simulated --compare", 2, "--compare needs --trajectory"},
      {"--columns t,hip_x,hip_y,hip_z", 2, "--columns needs --trajectory"},
      {"--trajectory way.csv --columns t,hip_x,hip_y,hip_z", 1, "way.csv, line 1: 't'"},
      {"--trajectory way.csv --columns t,hip_x,hip_y", 1, "no column 'hip_z'"},
      {"--trajectory way.csv --columns t,hip_x,hip_y,hip_z,-", 1,
       "way.csv, line 1: 4 values, but 5 columns are named"},
  };
  for (const auto& each : cases) {
    const Outcome outcome = shell.run(std::string("touch plane.xyz ") + each.arguments);
    EXPECT_EQ(outcome.code, each.code) << each.arguments;
    EXPECT_NE(outcome.err.find(each.words), std::string::npos) << each.arguments << outcome.err;
  }
}

// A probe that a hand leads over a ball with friction, its place and force measured with noise.
class Probe {
 public:
  static constexpr double kRadius = 0.05;    // m
  static constexpr double kStiffness = 500;  // N/m
  static constexpr double kFriction = 0.3;

  // Places and forces, without a header line; the places are those of a hand that a spring pulls to
  // the surface by the measured force.
  static std::string measured() {
    const SphereField ball(kRadius);
    ProxyOptions options;
    options.stiffness = kStiffness;
    options.friction = {kFriction, kFriction, 0};
    Proxy proxy(options);
    Random random(5);
    const auto noise = [&](double rms) {
      const Vector3d even(random.normal(), random.normal(), random.normal());
      return Vector3d(rms / std::sqrt(3.0) * even);
    };
    std::string text = "% t x y z fx fy fz flag\n";
    for (int i = 0; i < 1500; ++i) {
      const double turn = 1e-3 * std::max(i - 100, 0) * 0.05 / kRadius;
      const double out = kRadius + std::max(-3e-3, 5e-3 - 8e-5 * i);
      const Contact contact =
          proxy.step(ball, out * Vector3d(std::sin(turn), 0, std::cos(turn)), 1e-3);
      const Vector3d force = contact.force + noise(0.05);
      const Vector3d place = contact.proxy + noise(1e-4) - force / kStiffness;
      text += fmt::format("{} {} {} {} {} {} {} 1\n", 1e-3 * i, place.x(), place.y(), place.z(),
                          force.x(), force.y(), force.z());
    }
    return text;
  }

  // Evenly spread points.
  static std::string cloud() {
    constexpr int kPoints = 30000;  // 1 mm apart
    std::string text;
    for (int i = 0; i < kPoints; ++i) {
      const double z = 1 - (2 * i + 1.0) / kPoints;
      const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
      const double r = kRadius * std::sqrt(1 - z * z);
      text += fmt::format("{} {} {}\n", r * std::cos(turn), r * std::sin(turn), kRadius * z);
    }
    return text;
  }
};

TEST(Compare, TellsFrictionAndPlaceOfAProbesForces) {
  Shell shell;
  shell.write("ball.xyz", Probe::cloud());
  shell.write("probe.txt", Probe::measured());
  const std::string way =
      " --stiffness 500 --trajectory probe.txt --columns t,hip_x,hip_y,hip_z,fx,fy,fz,-";
  const std::string rough = " --friction-dynamic 0.3";
  const double right = compared(shell, "ball.xyz" + way + rough)["rms_N"].get<double>();
  const double smooth = compared(shell, "ball.xyz" + way)["rms_N"].get<double>();
  const double larger =
      compared(shell, "ball.xyz --scale 1.02" + way + rough)["rms_N"].get<double>();
  EXPECT_LT(right, 0.1);
  EXPECT_GT(smooth, 0.3);
  EXPECT_GT(larger, 0.4);  // by a millimetre
}

}  // namespace
}  // namespace palpate::app
