// The real-time contract of ToolProxy::step(): free, contact, creases, surfaces that move, faults.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "palpate/field/analytic.hpp"
#include "palpate/tool/tool_field.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "realtime/watch.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate::realtime {
namespace {

using Eigen::Vector3d;

class ToolStep : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_trap_system_calls()) {
      GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
    }
  }

  /// One watched step.
  ToolContact step(ToolProxy& proxy, const Field& field, const Pose& hand) {
    Watch watch;
    const ToolContact contact = proxy.step(field, hand, test::kTick);
    const Findings findings = watch.stop();
    EXPECT_EQ(findings.total(), 0) << findings;
    touching_ += contact.touching ? 1 : 0;
    lifted_ += has(contact.notes, ContactNote::reanchored) ? 1 : 0;
    cut_short_ += has(contact.notes, ContactNote::sweep_truncated) ? 1 : 0;
    return contact;
  }

  int touching_ = 0;
  int lifted_ = 0;
  int cut_short_ = 0;
};

// A hand that stirs in a ball and a floor which steps up and down, and leaps now and then.
Pose hand_at(int i) {
  const double t = test::kTick * i;
  Pose pose;
  pose.position = {0.05 * std::sin(3 * t), 0.05 * std::cos(2 * t), 0.03 * std::cos(5 * t)};
  if (i % 200 == 0) pose.position *= 20;
  pose.orientation = Eigen::AngleAxisd(2 * std::sin(t), Vector3d(1, 2, 3).normalized());
  pose.opening = 0.02 + 0.015 * std::sin(4 * t);
  return pose;
}

TEST_F(ToolStep, KeepsTheContractOnWhatMovesAndStands) {
  const SphereField ball(0.04);
  PlaneField floor({.reanchor_reach = 0.02});
  const UnionField all({&ball, &floor});
  for (const char* name : {"box:20x30x10", "capsule:50x4", "gripper:6x12x30"}) {
    ToolProxy proxy(std::make_shared<const Tool>(Tool::from_text(name, 4e-3)),
                    {.texture = {.amplitude = 1e-4}});
    for (int i = 0; i < 3000; ++i) {
      if (i % 50 == 0) {
        const double height = -0.03 + 0.005 * (i / 50 % 3);
        floor.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, height)));
      }
      (void)step(proxy, all, hand_at(i));
    }
  }
  EXPECT_GT(touching_, 2000);
  EXPECT_LT(touching_, 9000);
  EXPECT_GT(lifted_, 10);
  EXPECT_GT(cut_short_, 10);
}

// More samples near the surface than the solver takes constraints.
TEST_F(ToolStep, KeepsTheContractWithMoreSamplesThanConstraints) {
  const PlaneField floor;
  ToolProxy proxy(std::make_shared<const Tool>(Tool::box({0.04, 0.06, 0.02}, 1e-3)));
  Pose hand;
  for (int i = 0; i < 300; ++i) {
    hand.position.z() = 0.02 - 1e-4 * i;
    hand.orientation = Eigen::AngleAxisd(1e-4 * i, Vector3d::UnitX());
    (void)step(proxy, floor, hand);
  }
  EXPECT_GT(touching_, 150);
}

// A gripper on what a camera sees: a table and a ball that comes and goes, for half a second not
// seen at all.
TEST_F(ToolStep, KeepsTheContractOnAStream) {
  SourceOptions options;
  options.T_world_sensor = test::looking_down();
  Scene scene;
  Source& camera = scene.add("camera", options);
  const auto tool = std::make_shared<const Tool>(Tool::gripper({6e-3, 12e-3, 30e-3}, 4e-3));
  ToolField field(scene, tool);
  ToolProxy proxy(tool);
  for (int i = 0; i < 3000; ++i) {
    const double now = 1e-3 * i;
    if (i % 33 == 0 && (i < 1500 || i > 2000)) {
      const double height = 0.02 * std::sin(4 * now);
      const auto seen = [&](double x, double y) {
        return x * x + y * y < 0.01 ? 0.46 - height : 0.5;
      };
      camera.push(test::frame_of(test::small_camera(), now, seen, 3e-4, 1u + i),
                  [=] { return now; });
    }
    const Pose hand = hand_at(i);
    Watch watch;
    field.update(now, hand, proxy);
    const ToolContact contact = proxy.step(field, hand, test::kTick);
    const Findings found = watch.stop();
    ASSERT_EQ(found.total(), 0) << found;
    touching_ += contact.touching ? 1 : 0;
  }
  EXPECT_GT(touching_, 500);
  EXPECT_LT(touching_, 2900);
  EXPECT_GT(field.gathers(), 100u);
}

TEST_F(ToolStep, KeepsTheContractOnFaults) {
  const PlaneField floor;
  ToolProxy proxy(std::make_shared<const Tool>(Tool::ball(3e-3)));
  Pose hand;
  hand.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(step(proxy, floor, hand).notes, ContactNote::fault));
  Watch watch;
  proxy.reset(Pose());
  EXPECT_EQ(watch.stop().total(), 0);
}

}  // namespace
}  // namespace palpate::realtime
