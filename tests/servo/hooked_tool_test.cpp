// An L that a simulated hand hooks over an edge and pulls and turns: forces and torque that the
// device balances, against their closed form.
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "palpate/field/analytic.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "servo/guard_rig.hpp"
#include "servo/turning_rig.hpp"
#include "servo/wrench_guard.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kArm = 0.04;     // m, from the handle to the hook, along x
constexpr double kHook = 0.03;    // m, of the hook, down
constexpr double kHalfBox = 0.1;  // m
constexpr double kHookGyration = 0.03;
constexpr double kHookStiffness = 500;

// Two rows along the arm, and the hook at its end.
Tool hook() {
  std::vector<Tool::Point> samples;
  for (double x = 0; x < kArm - 4e-3; x += 4e-3) {
    for (const double y : {-5e-3, 5e-3}) samples.push_back({{x, y, 0}});
  }
  for (double s = 4e-3; s <= kHook; s += 4e-3) {
    for (const double y : {-5e-3, 5e-3}) samples.push_back({{kArm, y, -s}});
  }
  return Tool(std::move(samples));
}

// Springs one after the other.
double both(double a, double b) {
  return a * b / (a + b);
}

TEST(HookedTool, PullsAndTurnsAHandAsItsSpringsSay) {
  const Vector3d pulled(-8e-3, 0, -6e-3);  // by the hand, beyond where the L is held
  constexpr double kTurn = 0.05;           // the same of its turn, about y, rad
  const Vector3d held(kHalfBox - kArm, 0, kHalfBox);
  test::LedHand hand([&](double time) {
    const double share = std::min(1.0, time);
    return test::held_at(held + (1 - share) * Vector3d(5e-3, 0, 5e-3) + share * pulled,
                         share * kTurn);
  });
  const SimulatedDeviceOptions options = test::smooth_device(0.5);
  SimulatedDevice device(options, hand);
  const BoxField box(Vector3d::Constant(2 * kHalfBox));
  ToolProxy proxy(std::make_shared<const Tool>(hook()),
                  {.stiffness = kHookStiffness, .gyration = kHookGyration});
  WrenchGuard guard(test::plain(), device.info(), 1, kHookGyration);
  Wrench felt;
  for (int i = 0; i < 4000; ++i) {
    const DeviceState state = device.read();
    const Pose pose{state.position, state.orientation, 0};
    const ToolContact contact = proxy.step(box, pose, 1e-3);
    Guard::Input input = test::pushed(contact.wrench.force, state.position);
    input.velocity = state.velocity;
    felt = guard.pass(input, {contact.wrench, pose, state.angular_velocity});
    device.write_wrench(felt);
  }
  const double spring = both(kHookStiffness, options.hand.stiffness);
  const double turning =
      both(kHookStiffness * kHookGyration * kHookGyration, options.wrist->hand.stiffness);
  EXPECT_LT((felt.force + spring * pulled).norm(), 1e-6);
  EXPECT_LT((felt.torque + turning * kTurn * Vector3d::UnitY()).norm(), 1e-8);
  EXPECT_LT((proxy.pose().position - held).norm(), 1e-9);
}

}  // namespace
}  // namespace palpate
