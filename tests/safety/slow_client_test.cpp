// A client that is slower than the servo, or late: its hand is held for many steps while it moves.
#include "safety/slow_client.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "support/effort.hpp"
#include "support/point_shapes.hpp"
#include "support/snapshots.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kMostGiven = 1e-3;          // J
constexpr double kLargestStep = 0.3;         // N: the slew's in a step
constexpr double kLargestTorqueStep = 3e-3;  // N m
constexpr double kTwist = 0.1;               // rad
constexpr double kPressed = 7e-3;            // m
constexpr double kSway = 1.5e-3;             // m
constexpr const char* kTool = "box:20x30x10";

struct SlowScene {
  const char* name;
  std::vector<TestPoint> points;
  Vector3d touched;  // where the surface is
  Vector3d normal;   // there, out of it
};

std::vector<SlowScene> slow_scenes() {
  const Vector3d diagonal = Vector3d(1, 0, 1).normalized();
  return {{"sphere", ball({}, 0.03), {0, 0, 0.03}, Vector3d::UnitZ()},
          {"plane", plane(0), Vector3d::Zero(), Vector3d::UnitZ()},
          {"corner", wedge({}, std::numbers::pi / 2, 0.03), Vector3d::Zero(), diagonal}};
}

// From 10 mm in front of the surface to 7 mm deep in a second, then 1.5 mm to and fro at 1 Hz.
HandWay pressing(const SlowScene& scene, double lift) {
  return [&scene, lift](double t) {
    const double in = 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(t - 1, 0.0, 1.0));
    const double phase = 2 * std::numbers::pi * t;
    const double depth = -0.01 + in * (0.01 + kPressed + kSway * std::sin(phase));
    Pose pose;
    pose.position = scene.touched + (lift - depth) * scene.normal +
                    in * kSway * std::cos(phase) * Vector3d::UnitY();
    pose.orientation = Eigen::AngleAxisd(in * kTwist * std::sin(phase), Vector3d::UnitX());
    return pose;
  };
}

struct SlowCase {
  const char* name;
  Sending sending;
};

std::ostream& operator<<(std::ostream& out, const SlowCase& tested) {
  return out << tested.name;
}

class SlowClientAt : public testing::TestWithParam<SlowCase> {};

Pushed pushed_by(const SlowScene& scene, const Sending& sending, bool wrist, double duration) {
  Scene shown;
  shown.add("points").publish(still(scene.points));
  ServoOptions options;
  options.proxy.friction = {.static_coefficient = 0.3, .dynamic_coefficient = 0.3};
  if (wrist) options.tool = std::make_shared<const Tool>(Tool::from_text(kTool, 4e-3));
  return push(shown, options, sending, pressing(scene, wrist ? 5e-3 : 0), duration, wrist);
}

TEST_P(SlowClientAt, IsGivenNothingAndFeelsNoPulses) {
  const double duration = std::max(8, effort(20));  // s
  for (const SlowScene& scene : slow_scenes()) {
    for (const bool wrist : {false, true}) {
      const Pushed pushed = pushed_by(scene, GetParam().sending, wrist, duration);
      SCOPED_TRACE(std::string(scene.name) + (wrist ? ", with a wrist" : ""));
      const std::string of = std::string("_") + scene.name + (wrist ? "_wrist" : "");
      RecordProperty("energy_mJ" + of, std::to_string(1e3 * pushed.energy));
      RecordProperty("step_N" + of, std::to_string(pushed.step));
      RecordProperty("torque_step_mNm" + of, std::to_string(1e3 * pushed.torque_step));
      RecordProperty("force_N" + of, std::to_string(pushed.largest));
      EXPECT_LE(pushed.energy, kMostGiven);
      EXPECT_LE(pushed.torque_step, kLargestTorqueStep);
      EXPECT_LE(pushed.step, kLargestStep + 1e-9);
      EXPECT_GT(pushed.largest, 0.03) << "nothing was felt";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rates, SlowClientAt,
    testing::Values(SlowCase{"20_Hz", {.rate = 20}}, SlowCase{"30_Hz", {.rate = 30}},
                    SlowCase{"62_Hz", {.rate = 62}}, SlowCase{"100_Hz", {.rate = 100}},
                    SlowCase{"250_Hz", {.rate = 250}}, SlowCase{"1000_Hz", {.rate = 1000}},
                    SlowCase{"20_Hz_yielding", {.rate = 20, .yields = true}},
                    SlowCase{"62_Hz_yielding", {.rate = 62, .yields = true}},
                    SlowCase{"250_Hz_yielding", {.rate = 250, .yields = true}},
                    SlowCase{"1000_Hz_stalls_yielding",
                             {.rate = 1000, .stall = 0.06, .yields = true}},
                    SlowCase{"30_Hz_jitter", {.rate = 30, .jitter = 0.4}},
                    SlowCase{"100_Hz_jitter", {.rate = 100, .jitter = 0.4}},
                    SlowCase{"1000_Hz_jitter", {.rate = 1000, .jitter = 0.4}},
                    SlowCase{"100_Hz_stalls", {.rate = 100, .stall = 0.06}},
                    SlowCase{"1000_Hz_stalls", {.rate = 1000, .stall = 0.06}},
                    SlowCase{"1000_Hz_short_stalls", {.rate = 1000, .stall = 0.015}},
                    SlowCase{"1000_Hz_bursts", {.rate = 1000, .burst = 0.03}}),
    [](const auto& tested) { return std::string(tested.param.name); });

// What is judged step by step, as if the hand had stood still and leapt, is given energy in pulses.
TEST(SlowClient, IsPushedWhereItsReadingsAreNotTold) {
  const SlowScene sphere = slow_scenes().front();
  const Pushed pushed = pushed_by(sphere, {.rate = 30, .tells_time = false}, false, 20);
  RecordProperty("energy_mJ", std::to_string(1e3 * pushed.energy));
  RecordProperty("step_N", std::to_string(pushed.step));
  EXPECT_GT(pushed.energy, 10 * kMostGiven);
  EXPECT_GT(pushed.step, 3 * kLargestStep);
}

}  // namespace
}  // namespace palpate::test
