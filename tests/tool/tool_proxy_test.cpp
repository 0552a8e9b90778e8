// What a tool's proxy promises besides exact forces: it is the proxy of a point where the tool is a
// ball, follows what moves, and softens with the surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/numbers.hpp"
#include "contact/test_fields.hpp"
#include "palpate/base/error.hpp"
#include "palpate/field/analytic.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// The largest difference of forces between a ball as a tool and the proxy of a point whose field
/// has a tool radius, N, over the ticks of a curved path.
double difference_to_proxy(const Field& surface, const Field& pushed_out, double height) {
  ToolProxy six = proxy_of(Tool::ball(0.003), {.stiffness = 500});
  Proxy three({.stiffness = 500, .tangent_tolerance = 1e-6});
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double t = kTick * i;
    const Vector3d hand(0.02 * std::sin(3 * t), 0.02 * std::cos(2.3 * t),
                        height + 0.004 * std::cos(5 * t));
    const ToolContact contact =
        six.step(surface, pose_at(hand, {0.3 * std::sin(t), 0.2 * t, 0}), kTick);
    const Contact point = three.step(pushed_out, hand, kTick);
    worst = std::max(worst, (contact.wrench.force - point.force).norm());
    EXPECT_LT(contact.wrench.torque.norm(), 1e-12);
  }
  return worst;
}

TEST(ToolProxy, ABallIsTheProxyWithAToolRadius) {
  const AnalyticField::Options ball{.tool_radius = 0.003};
  EXPECT_LT(difference_to_proxy(PlaneField(), PlaneField(ball), 0), 1e-9);
  EXPECT_LT(difference_to_proxy(SphereField(0.05), SphereField(0.05, ball), 0.05), 2e-3);
}

// The plane steps up and down under a box that rests: it goes along in the tick, flat.
TEST(ToolProxy, APlaneThatStepsTakesABoxAlong) {
  PlaneField plane({.reanchor_reach = 0.02});
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), {.gyration = 0.03});
  Random random(4);
  const Pose hand = pose_at({0, 0, -0.02}, {0.02, -0.01, 0});
  (void)press(proxy, plane, pose_at({0, 0, 0.05}), hand);
  int lost = 0;
  int lifted = 0;
  double off = 0;       // N
  double stiffest = 0;  // N/m
  double deepest = 0;
  for (int i = 0; i < 300; ++i) {
    const double height = 0.015 * (random.uniform() - 0.5);
    plane.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, height)));
    for (int tick = 0; tick < 20; ++tick) {
      const ToolContact contact = proxy.step(plane, hand, kTick);
      lost += contact.touching && contact.touch_count > 0 ? 0 : 1;
      lifted += has(contact.notes, ContactNote::reanchored) ? 1 : 0;
      deepest = std::max(deepest, depth_of(proxy, plane));
      // It lies flat: the way from the hand is known, the stiffness is what is paid for. It falls
      // by 0.75 R in a tick, and the plane by 1.5 R.
      if (tick < 2) continue;
      const double stretch = height + 0.01 - hand.position.z();
      const double force = contact.wrench.force.z();
      off = std::max(off, std::abs(force - contact.stiffness * stretch));
      stiffest = std::max(stiffest, contact.stiffness);
    }
  }
  EXPECT_LT(off, 0.02);
  EXPECT_LE(stiffest, 500 + 1e-9);
  EXPECT_EQ(lost, 0);
  EXPECT_LT(deepest, 0.02 * kSupport);
  EXPECT_GT(lifted, 100);
}

// What was known of gaps does not hold for a surface that has moved: a floor that rises into a tool
// which hovers over it, too near to be free for certain.
TEST(ToolProxy, APlaneThatRisesMeetsAToolAtRest) {
  PlaneField plane({.reanchor_reach = 0.02});
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
  const Pose hand = pose_at({0, 0, 0.012});
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(proxy.step(plane, hand, kTick).touching);
  }
  plane.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.005)));
  EXPECT_TRUE(proxy.step(plane, hand, kTick).touching);
  EXPECT_LT(depth_of(proxy, plane), 0.02 * kSupport);
}

// Farther than the surface says that it steps: the old spring fades, and what takes its place is
// paid for. The force is as it was in the tick before.
TEST(ToolProxy, AJumpOfTheSurfaceDoesNotStepTheForce) {
  PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), {.gyration = 0.03});
  const Pose hand = pose_at({0, 0, 0.005});
  const ToolContact before = press(proxy, plane, pose_at({0, 0, 0.05}), hand);
  plane.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.004)));
  const ToolContact after = proxy.step(plane, hand, kTick);
  EXPECT_NEAR(before.wrench.force.z(), 2.5, 1e-9);
  EXPECT_NEAR(after.wrench.force.z(), 2.5, 0.15);
  EXPECT_NEAR(after.proxy.position.z(), 0.014, 1e-5);
  ToolContact later;
  for (int i = 0; i < 500; ++i) later = proxy.step(plane, hand, kTick);
  EXPECT_LE(later.wrench.force.z(), 4.5);
  EXPECT_TRUE(has(later.notes, ContactNote::softer));
}

// A hand that leaps along a plane: the tool catches up in some steps, and nothing has fallen.
TEST(ToolProxy, CatchingUpIsNoFall) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
  (void)press(proxy, plane, pose_at({0, 0, 0.05}), pose_at({0, 0, 0.009}));
  int lagging = 0;
  ToolContact contact;
  for (int i = 0; i < 50; ++i) {
    contact = proxy.step(plane, pose_at({0.06, 0, 0.009}), kTick);
    lagging += has(contact.notes, ContactNote::sweep_truncated) ? 1 : 0;
    EXPECT_FALSE(has(contact.notes, ContactNote::fell));
  }
  EXPECT_GE(lagging, 2);
  EXPECT_LE(lagging, 10);
  EXPECT_LT((contact.wrench.force - Vector3d(0, 0, 0.5)).norm(), 1e-6);
}

TEST(ToolProxy, TheSurfaceSoftensTheWholeWrench) {
  const PlaneField soft({.surface = {.stiffness_factor = 0.5, .presence = 0.5, .source = 3}});
  const PlaneField hard;
  const Tool tool = Tool::box({0.04, 0.06, 0.02}, 5e-3);
  ToolProxy one = proxy_of(tool);
  ToolProxy other = proxy_of(tool);
  const Pose from = pose_at({0, 0, 0.05});
  const Pose to = pose_at({0, 0, 0.008}, {0.2, 0.1, 0});
  const ToolContact a = press(one, soft, from, to);
  const ToolContact b = press(other, hard, from, to);
  EXPECT_LT((4 * a.wrench.force - b.wrench.force).norm(), 1e-6);
  EXPECT_LT((4 * a.wrench.torque - b.wrench.torque).norm(), 1e-6);
  EXPECT_EQ(a.source, 3);
}

// Both fingers close on a box between them, which is wider than the hand's opening.
TEST(ToolProxy, AGripperIsHeldOpenByWhatItHolds) {
  const BoxField box({0.02, 0.05, 0.05});
  ToolProxy proxy = proxy_of(Tool::gripper({0.006, 0.012, 0.03}, 0.004));
  Pose hand = pose_at({0, 0, 0.03}, Vector3d::Zero(), 0.03);
  proxy.reset(hand);
  ToolContact contact;
  for (int i = 0; i < 500; ++i) {
    hand.opening = std::max(0.016, 0.03 - 1e-4 * i);
    contact = proxy.step(box, hand, kTick);
  }
  EXPECT_NEAR(contact.wrench.grip, 500 * 0.004, 1e-9);
  EXPECT_NEAR(contact.proxy.opening, 0.02, 1e-12);
  EXPECT_LT(contact.wrench.force.norm(), 1e-9);
  EXPECT_LT(contact.wrench.torque.norm(), 1e-9);
}

// A hand that squeezes beyond that finds the gripper closed, in the air as well as on a floor that
// it is pressed onto, with more samples than the solver takes.
TEST(ToolProxy, AClosedGripperIsClosedEverywhere) {
  const PlaneField floor;
  ToolProxy proxy = proxy_of(Tool::gripper({0.02, 0.03, 0.01}, 1e-3));
  proxy.reset(pose_at({0, 0, 0.05}, Vector3d::Zero(), -0.004));
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    const double t = kTick * i;
    const Pose hand = pose_at({0.01 * t, 0, std::max(5e-3, 0.05 - 5e-4 * i)},
                              {0.1 * std::sin(20 * t), 0.1 * std::cos(30 * t), 0}, -0.004);
    const ToolContact contact = proxy.step(floor, hand, kTick);
    touching += contact.touching ? 1 : 0;
    // A floor that is not flat under both fingers opens them: it never crosses them.
    EXPECT_GE(contact.proxy.opening, -1e-10);
    EXPECT_EQ(contact.touching || contact.wrench.grip == 0, true);
  }
  EXPECT_GT(touching, 150);
  for (int i = 0; i < 300; ++i) (void)proxy.step(floor, pose_at({0, 0, 0.05}), kTick);
  EXPECT_EQ(proxy.pose().opening, 0);
}

TEST(ToolProxy, ARigidToolHasNoOpening) {
  const PlaneField floor;
  ToolProxy one = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), kOptions);
  ToolProxy other = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), kOptions);
  for (int i = 0; i < 200; ++i) {
    const Vector3d position(0, 0, 0.02 - 1e-4 * i);
    const Pose opened = pose_at(position, {0.1, 0, 0}, 0.03 * std::sin(0.1 * i));
    const Wrench a = one.step(floor, opened, kTick).wrench;
    const Wrench b = other.step(floor, pose_at(position, {0.1, 0, 0}), kTick).wrench;
    EXPECT_EQ(a.force, b.force);
    EXPECT_EQ(a.torque, b.torque);
    EXPECT_EQ(a.grip, 0);
  }
}

/// A plane that counts what it is asked, and what of it outside of a proxy's steps, where its
/// budget is another.
class SteppedPlaneField final : public Field {
 public:
  mutable int late = 0;
  mutable int surfaces = 0;
  mutable int asked = 0;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    return counted(), plane_.sample(x);
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return counted(), plane_.is_free(ball);
  }
  [[nodiscard]] Surface surface(const Vector3d& x) const noexcept override {
    ++surfaces;
    return counted(), plane_.surface(x);
  }
  [[nodiscard]] Traits traits() const noexcept override { return plane_.traits(); }
  void begin_step() const noexcept override { within_ = true; }
  void end_step(const Vector3d&, const Vector3d&) const noexcept override { within_ = false; }
  void step_to(double height) {
    plane_.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0, 0, height)));
  }

 private:
  void counted() const noexcept {
    ++asked;
    late += within_ ? 0 : 1;
  }

  PlaneField plane_{{.reanchor_reach = 0.1}};
  mutable bool within_ = false;
};

TEST(ToolProxy, AsksTheFieldOnlyWithinItsSteps) {
  SteppedPlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
  for (int i = 0; i < 1000; ++i) {
    const double t = kTick * i;
    plane.asked = 0;
    if (i % 50 == 0) plane.step_to(1e-3 * (i % 100));
    const Pose hand = pose_at({0, 0, 0.01 + 0.01 * std::cos(20 * t)}, {0.2 * t, 0.1, 0});
    const ToolContact contact = proxy.step(plane, hand, kTick);
    EXPECT_EQ(contact.evaluations, plane.asked);
    EXPECT_LE(contact.evaluations, proxy.max_evaluations());
  }
  EXPECT_EQ(plane.late, 0);
  EXPECT_GT(plane.surfaces, 100);
}

// A tetrahedron of a mesh, tip down: its tip is what touches, and bears what a stick would.
TEST(ToolProxy, AMeshTouchesWithItsCorner) {
  const PlaneField plane;
  const std::vector<Vector3d> vertices{
      {0, 0, -0.02}, {0.01, 0, 0.01}, {-0.01, 0.01, 0.01}, {-0.01, -0.01, 0.01}};
  const std::vector<Tool::Triangle> faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  ToolProxy proxy = proxy_of(Tool::mesh(vertices, faces, 4e-3), kOptions);
  const ToolContact contact = press(proxy, plane, pose_at({0, 0, 0.05}), pose_at({0, 0, 0.017}));
  ASSERT_EQ(contact.touch_count, 1);
  EXPECT_LT((contact.touches[0].position).norm(), 1e-9);
  EXPECT_LT((contact.wrench.force - Vector3d(0, 0, kStiffness * 3e-3)).norm(), 1e-7);
  EXPECT_LT(contact.wrench.torque.norm(), 1e-9);
}

// The same after reset() into a solid, which was touched before.
TEST(ToolProxy, ComesOutOfWhatItIsPutInto) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
  const Pose hand = pose_at({0, 0, 0.002}, {0.05, 0, 0});
  (void)press(proxy, plane, pose_at({0, 0, 0.05}), pose_at({0, 0, 0.005}));
  proxy.reset(hand);
  EXPECT_EQ(proxy.pose().position, hand.position);
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    largest = std::max(largest, proxy.step(plane, hand, kTick).wrench.force.norm());
  }
  EXPECT_LT(depth_of(proxy, plane), 0.02 * kSupport);
  EXPECT_LT(largest, 0.1);
}

// Where the tool begins in a solid it comes out, and no force steps up.
TEST(ToolProxy, ComesOutOfWhatItBeginsIn) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
  const Pose hand = pose_at({0, 0, 0.002});
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    largest = std::max(largest, proxy.step(plane, hand, kTick).wrench.force.norm());
  }
  EXPECT_LT(depth_of(proxy, plane), 0.02 * kSupport);
  EXPECT_LT(largest, 0.1);
}

}  // namespace
}  // namespace palpate::test
