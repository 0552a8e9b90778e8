// A peg in a hole: how far it moves and turns before walls hold it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "palpate/field/analytic.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// Solid below z = 0, but for a round hole along z without a bottom.
class HoleField final : public Field {
 public:
  explicit HoleField(double radius) : radius_(radius) {}

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const double rho = x.head<2>().norm();
    const double wall = radius_ - rho;  // above 0 in the hole
    const Vector3d inward =
        rho > 0 ? Vector3d(-x.x() / rho, -x.y() / rho, 0) : Vector3d(Vector3d::UnitX());
    Sample sample{.value = x.z(), .gradient = Vector3d::UnitZ(), .support = 1, .radius = 0.01};
    if (x.z() >= 0 && wall > 0) {
      sample.value = std::hypot(wall, x.z());
      if (sample.value > 0)
        sample.gradient = (x.z() * Vector3d::UnitZ() + wall * inward) / sample.value;
    } else if (x.z() < 0 && wall > x.z()) {
      sample.value = wall;
      sample.gradient = inward;
    }
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return sample(ball.center).value > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {.source = 0}; }
  [[nodiscard]] Traits traits() const noexcept override { return {.resolution = 2e-5}; }

 private:
  double radius_;
};

constexpr double kPeg = 0.009;       // m, the peg's radius
constexpr double kHole = 0.01;       // m, the hole's
constexpr double kPegLength = 0.04;  // m
constexpr double kInHole = -0.03;    // m, where the peg's middle is

ToolProxy peg() {
  std::vector<Tool::Point> samples;
  for (int i = 0; i < 720; ++i) {
    const double angle = std::numbers::pi * i / 360;
    for (const double z : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      samples.push_back({{kPeg * std::cos(angle), kPeg * std::sin(angle), z * kPegLength}, 0, 0});
    }
  }
  return proxy_of(Tool(std::move(samples)), kOptions);
}

/// How far wrenches were from the truth at most, N and N m.
struct WrenchErrors {
  void see(const Wrench& wrench, const Vector3d& true_force, const Vector3d& true_torque) {
    force = std::max(force, (wrench.force - true_force).norm());
    torque = std::max(torque, (wrench.torque - true_torque).norm());
  }
  void expect_none() const {
    EXPECT_LT(force, 1e-9);
    EXPECT_LT(torque, 1e-9);
  }

  double force = 0;
  double torque = 0;
};

TEST(PegInAHole, IsFreeSidewaysAndThenHeldByItsWall) {
  const HoleField hole(kHole);
  ToolProxy proxy = peg();
  proxy.reset(pose_at({0, 0, kInHole}));
  WrenchErrors errors;
  for (int i = 0; i < 300; ++i) {
    const double x = 1e-5 * i;
    const ToolContact contact = proxy.step(hole, pose_at({x, 0, kInHole}), kTick);
    const Vector3d truth(-kStiffness * std::max(0.0, x - (kHole - kPeg)), 0, 0);
    errors.see(contact.wrench, truth, Vector3d::Zero());
  }
  errors.expect_none();
}

// Both rings of its ends touch the wall, on opposite sides, when 2 a cos t + h sin t = 2 b.
TEST(PegInAHole, TiltsUntilItJams) {
  double jam = 0;
  for (int i = 0; i < 60; ++i) {
    const double open = 2 * kPeg * std::cos(jam) + kPegLength * std::sin(jam) - 2 * kHole;
    jam -= open / (kPegLength * std::cos(jam) - 2 * kPeg * std::sin(jam));
  }
  const HoleField hole(kHole);
  ToolProxy proxy = peg();
  proxy.reset(pose_at({0, 0, kInHole}));
  WrenchErrors errors;
  for (int i = 0; i < 400; ++i) {
    const double tilt = 5e-4 * i;
    ToolContact contact;
    for (int k = 0; k < 10; ++k) {
      contact = proxy.step(hole, pose_at({0, 0, kInHole}, {0, tilt, 0}), kTick);
    }
    const Vector3d truth(0, -kTurnStiffness * std::max(0.0, tilt - jam), 0);
    errors.see(contact.wrench, Vector3d::Zero(), truth);
  }
  EXPECT_GT(jam, 0.02);
  EXPECT_LT(jam, 0.15);
  errors.expect_none();
}

}  // namespace
}  // namespace palpate::test
