// `palpate touch camera:remote`: another program is the camera (docs/remote_camera.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "sensor/remote_sender.hpp"
#include "support/contains.hpp"

namespace palpate::app {
namespace {

using test::contains;

constexpr double kPi = 3.14159265358979323846;

bool comes_true(const std::function<bool()>& condition) {
  constexpr int kTries = 60'000;
  for (int i = 0; i < kTries; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

// A wall 0.7 m ahead; one pixel tells frames apart.
test::RemoteFrame remote_wall(std::uint16_t number) {
  test::RemoteFrame frame;
  frame.width = 80;
  frame.height = 60;
  frame.lens = {75, 75, 39.5, 29.5};
  frame.unit = 1e-4;
  frame.steps.assign(80 * 60, 7000);
  frame.steps[0] = static_cast<std::uint16_t>(7000 + number % 100);
  return frame;
}

// Sends walls until it is told to leave.
class WallSender {
 public:
  explicit WallSender(std::string path)
      : thread_([path = std::move(path)](const std::stop_token& stop) {
          const test::RemoteSender sender(path);
          for (std::uint16_t k = 0; !stop.stop_requested() && sender.send(remote_wall(k)); ++k) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
          }
        }) {}

 private:
  std::jthread thread_;
};

// Again and again 4 mm into the wall and 10 mm in front of it: however late a busy machine is with
// the first frame, the hand meets what it shows from the front.
std::string into_far_wall() {
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 6000; ++i) {
    way += fmt::format("{},0,0,{}\n", 1e-3 * i, 0.697 - 7e-3 * std::cos(kPi * 1e-3 * i));
  }
  return way;
}

TEST(RemoteCameraProgram, WaitsForTheCameraAndFeelsWhatItSends) {
  Shell shell;
  shell.write("way.csv", into_far_wall());
  const auto run = shell.start(
      "touch camera:remote:socket --trajectory way.csv --stiffness 500 --json run.json --log "
      "log.csv");
  ASSERT_TRUE(comes_true([&] {
    return contains(shell.read("stderr"), "no program is connected to 'socket'; start one");
  })) << shell.read("stderr");
  test::RemoteFrame bad = remote_wall(0);
  bad.unit = 700;
  EXPECT_TRUE(test::RemoteSender(shell.path("socket")).send(bad));
  ASSERT_TRUE(comes_true([&] { return contains(shell.read("stderr"), "the unit is 700"); }));
  {
    const WallSender sender(shell.path("socket"));
    ASSERT_TRUE(comes_true([&] { return !shell.read("run.json").empty(); }))
        << shell.read("stderr");
  }
  auto log = columns(shell.read("log.csv"));
  const std::vector<std::string>& fz = log["fz"];
  ASSERT_FALSE(fz.empty());
  const auto deepest = std::ranges::min_element(
      fz, {}, [](const std::string& cell) { return number(cell); });  // where it pushes most
  const auto at = static_cast<std::size_t>(deepest - fz.begin());
  EXPECT_NEAR(number(*deepest), -500 * 4e-3, 0.5) << "towards the camera";
  EXPECT_NEAR(number(log["fx"][at]), 0, 0.1);
  EXPECT_NEAR(number(log["fy"][at]), 0, 0.1);
  EXPECT_NEAR(number(log["proxy_z"][at]), 0.7, 3e-4);
  const Json report = Json::parse(shell.read("run.json"));
  EXPECT_GT(report["sources"][0]["frames_touchable"].get<int>(), 2);
}

TEST(RemoteCameraProgram, GoesOnWithTheNextProgram) {
  Shell shell;
  const auto run = shell.start("touch camera:remote:socket --duration 600 --json run.json");
  const auto says = [&](const char* words) {
    return comes_true([&] { return contains(shell.read("stderr"), words); });
  };
  ASSERT_TRUE(says("no program is connected to 'socket'"));
  {
    const WallSender sender(shell.path("socket"));
    ASSERT_TRUE(says("| remote ")) << shell.read("stderr");
  }
  ASSERT_TRUE(says("STALLED")) << shell.read("stderr");
  const WallSender next(shell.path("socket"));
  ASSERT_TRUE(comes_true([&] {
    const std::string told = shell.read("stderr");
    return contains(told.substr(told.rfind("STALLED")), "| remote ");
  })) << shell.read("stderr");
  EXPECT_EQ(run->interrupt(), 0) << shell.read("stderr");
  const Json source = Json::parse(shell.read("run.json"))["sources"][0];
  EXPECT_EQ(source["stalls"].get<int>(), 1);
  EXPECT_TRUE(contains(source["problem"].get<std::string>(), ": no program is connected to"))
      << source["problem"];
}

}  // namespace
}  // namespace palpate::app
