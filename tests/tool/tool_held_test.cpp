// Where a tool cannot go on: inputs and fields that are wrong, constraints that contradict each
// other, solids that say nothing of where they end.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "contact/test_fields.hpp"
#include "palpate/base/error.hpp"
#include "palpate/field/analytic.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

TEST(ToolHeld, LatchesAFaultOnWhatIsNotFinite) {
  const PlaneField plane;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pose turned_wrong = pose_at({0, 0, 0.005});
  turned_wrong.orientation.coeffs().setZero();
  Pose turned_far = pose_at({0, 0, 0.005});
  turned_far.orientation.w() = std::numeric_limits<double>::infinity();
  Pose turned_long = pose_at({0, 0, 0.005});
  turned_long.orientation.w() = 1e200;  // finite, but for its square
  for (const auto& [hand, dt] :
       {std::pair(pose_at({0, nan, 0}), kTick), std::pair(turned_wrong, kTick),
        std::pair(turned_far, kTick), std::pair(turned_long, kTick),
        std::pair(pose_at({0, 0, 2e9}), kTick), std::pair(pose_at({0, 0, 0}), -1.0),
        std::pair(pose_at({0, 0, 0}, Vector3d::Zero(), nan), kTick)}) {
    ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
    (void)press(proxy, plane, pose_at({0, 0, 0.05}), pose_at({0, 0, 0.005}));
    EXPECT_TRUE(has(proxy.step(plane, hand, dt).notes, ContactNote::fault));
    const ToolContact after = proxy.step(plane, pose_at({0, 0, 0.005}), kTick);
    EXPECT_TRUE(has(after.notes, ContactNote::fault));
    EXPECT_EQ(after.wrench.force, Vector3d(0, 0, 0));
    proxy.reset(pose_at({0, 0, 0.05}));
    EXPECT_FALSE(has(proxy.step(plane, pose_at({0, 0, 0.05}), kTick).notes, ContactNote::fault));
  }
}

/// Wrong: gradients that are not finite below z = 5 mm. Counts where it is asked.
class BrokenField final : public Field {
 public:
  mutable int not_finite = 0;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    not_finite += x.allFinite() ? 0 : 1;
    Sample sample{.value = x.z(), .support = 1, .radius = kSupport};
    sample.gradient = Vector3d(0, 0, x.z() < 5e-3 ? std::numeric_limits<double>::infinity() : 1);
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    not_finite += ball.center.allFinite() ? 0 : 1;
    return ball.center.z() > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Traits traits() const noexcept override { return {.resolution = 2e-5}; }
};

// A field that is wrong holds the tool: nothing that is not finite is asked for or reported.
TEST(ToolHeld, TakesWhatIsNotFiniteForSolid) {
  const BrokenField field;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3));
  ToolContact contact;
  for (int i = 0; i < 200; ++i) {
    contact = proxy.step(field, pose_at({0, 0, 0.03 - 2e-4 * i}), kTick);
    EXPECT_TRUE(contact.wrench.force.allFinite() && contact.wrench.torque.allFinite());
    EXPECT_TRUE(contact.proxy.position.allFinite());
  }
  EXPECT_TRUE(has(contact.notes, ContactNote::sweep_truncated));
  EXPECT_FALSE(has(contact.notes, ContactNote::fault));
  EXPECT_GT(contact.proxy.position.z(), 0.01);
  EXPECT_EQ(field.not_finite, 0);
}

TEST(ToolHeld, ChecksItsOptions) {
  const Tool tool = Tool::box({0.04, 0.06, 0.02}, 5e-3);
  EXPECT_THROW(ToolProxy(nullptr), Error);
  EXPECT_THROW(proxy_of(tool, {.stiffness = -1}), Error);
  EXPECT_THROW(proxy_of(tool, {.gyration = std::numeric_limits<double>::infinity()}), Error);
  EXPECT_THROW(proxy_of(tool, {.gyration = 1e-300}), Error);
  EXPECT_THROW(proxy_of(tool, {.gyration = 11}), Error);
  EXPECT_THROW(proxy_of(tool, {.iterations = 7}), Error);
  EXPECT_DOUBLE_EQ(proxy_of(tool).options().gyration, 0.5 * tool.extent());
  const Tool thin({{{0.008, 0, 0}, 0, 0}, {{0, 0, 0}, 0.05, 0}});
  EXPECT_DOUBLE_EQ(proxy_of(thin).options().gyration, 0.01);
  EXPECT_GT(proxy_of(Tool({{Vector3d::Zero(), 0, 0}})).options().gyration, 0);
}

/// Solid below z = 0, with normals that are far off, otherwise in each cube of 3 mm.
class WrongNormalsField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const Vector3d cell = (x / 3e-3).array().floor();
    const double angle = cell.dot(Vector3d(12.9898, 78.233, 37.719));
    const Vector3d normal(3 * std::cos(angle), 3 * std::sin(angle), 1);
    return {.value = x.z(), .gradient = normal.normalized(), .support = 1, .radius = kSupport};
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return ball.center.z() > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Traits traits() const noexcept override { return {.resolution = 2e-5}; }
};

// Constraints contradict each other there: the tool stays where it was looked at and is outside.
TEST(ToolHeld, GoesBackFromWhatItCannotSolve) {
  const WrongNormalsField field;
  ToolProxy proxy = proxy_of(Tool::capsule(0.03, 0.003, 0.005));
  proxy.reset(pose_at({0, 0, 0.04}));
  int unfinished = 0;
  double deepest = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pose hand = pose_at({1e-4 * i, 0, 0.04 - 2e-5 * i});
    const ToolContact contact = proxy.step(field, hand, kTick);
    unfinished += has(contact.notes, ContactNote::not_converged) ? 1 : 0;
    deepest = std::max(deepest, depth_of(proxy, field));
  }
  EXPECT_GT(unfinished, 100);
  EXPECT_LT(deepest, 0.02 * kSupport);
}

/// Free between two walls that lean by nearly nothing against each other.
class SlotField final : public Field {
 public:
  double half = 0.02;  // of its width, m
  double lean = 3e-8;  // rad
  std::uint64_t revision = 0;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    const double side = x.x() > 0 ? 1 : -1;
    const Vector3d normal = Vector3d(-side, 0, x.x() > 0 ? 0 : lean).normalized();
    return {.value = half - std::abs(x.x()), .gradient = normal, .support = 1, .radius = kSupport};
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return half - std::abs(ball.center.x()) > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Traits traits() const noexcept override {
    return {.resolution = 2e-5, .revision = revision, .reanchor_reach = 5e-3, .step = 5e-3};
  }
};

// A tool as wide as a slot slides along it, though its constraints contradict each other by what
// the solver cannot tell from rounding.
TEST(ToolHeld, SlidesInASlotAsWideAsItIs) {
  for (const double lean : {0.0, 1e-9, -3e-8, -3e-7, 3e-7, 1e-5}) {
    SlotField slot;
    slot.half = 0.01;
    slot.lean = lean;
    ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 5e-3));
    proxy.reset(pose_at({0, 0, 0}));
    double lag = 0;
    for (int i = 0; i < 300; ++i) {
      const Pose hand = pose_at({3e-3, 0, 2e-4 * i});
      const ToolContact contact = proxy.step(slot, hand, kTick);
      lag = std::max(lag, hand.position.z() - contact.proxy.position.z());
      EXPECT_LT(depth_of(proxy, slot), 0.02 * kSupport);
    }
    EXPECT_LT(lag, 1e-3) << lean;
  }
}

// A slot that closes on a tool squeezes it: there is no way out along the nearly opposed normals.
// Whenever a step leaves it deep inside, the step says so; what it moves stays small.
TEST(ToolHeld, SaysThatItIsSqueezed) {
  for (const bool turned_about : {false, true}) {
    SlotField slot;
    ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 5e-3));
    const Pose hand = pose_at({1e-3, 0, 0}, {0, 0, turned_about ? 0.2 : 0.0});
    proxy.reset(hand);
    int deep = 0;
    int silent = 0;
    double farthest = 0;
    for (int i = 0; i < 400; ++i) {
      if (i % 20 == 0) {
        slot.half -= 1e-3;
        ++slot.revision;
      }
      const ToolContact contact = proxy.step(slot, hand, kTick);
      const bool is_deep = depth_of(proxy, slot) > 0.05 * kSupport;
      deep += is_deep ? 1 : 0;
      silent += is_deep && !has(contact.notes, ContactNote::not_converged) ? 1 : 0;
      farthest = std::max(farthest, (contact.proxy.position - hand.position).norm());
      EXPECT_FALSE(has(contact.notes, ContactNote::fault));
    }
    EXPECT_GT(deep, 100);
    EXPECT_EQ(silent, 0);
    EXPECT_LT(farthest, 0.02);
  }
}

// A slot that has closed on a tool holds a hand that presses, and lets go of one that pulls with
// more than 10 N from more than 10 R: after a second the spring fades within half a second, and
// nothing holds the hand, which is still inside.
TEST(ToolHeld, IsLetGoWhereItIsHeldHardInside) {
  SlotField slot;
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 5e-3));
  proxy.reset(pose_at({0, 0, 0}));
  (void)proxy.step(slot, pose_at({0, 0, 0}), kTick);
  slot.half = 0.005;
  ++slot.revision;
  double held = 0;
  double step = 0;
  Vector3d last = Vector3d::Zero();
  ToolContact contact;
  for (int i = 0; i < 2000; ++i) {
    contact = proxy.step(slot, pose_at({5e-6 * i, 0, 0}), kTick);
    EXPECT_FALSE(has(contact.notes, ContactNote::freed)) << i;
  }
  EXPECT_NEAR(contact.wrench.force.x(), -500 * 0.01, 1);
  last = contact.wrench.force;
  for (int i = 0; i < 2600; ++i) {
    contact = proxy.step(slot, pose_at({0.01 + 1e-4 * i, 0, 0}), kTick);
    held = std::max(held, contact.wrench.force.norm());
    step = std::max(step, (contact.wrench.force - last).norm());
    last = contact.wrench.force;
  }
  EXPECT_GT(held, 50);
  EXPECT_LT(step, 1);
  EXPECT_TRUE(has(contact.notes, ContactNote::inside));
  EXPECT_EQ(contact.wrench.force, Vector3d(0, 0, 0));
  EXPECT_EQ(contact.proxy.position.x(), 0.01 + 1e-4 * 2599);
}

// Nothing is known of where a solid ends: the tool stays, until it is free.
TEST(ToolHeld, StaysWhereTheSolidIsUnknown) {
  DullPlateField plate;
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.02, 0.02}, 5e-3), {.stiffness = 500});
  (void)press(proxy, plate, pose_at({0, 0, 0.03}), pose_at({0, 0, 0.008}));
  const Pose before = proxy.pose();
  plate.dull = true;
  for (int i = 0; i < 20; ++i) {
    const ToolContact contact = proxy.step(plate, pose_at({1e-4 * i, 0, 0.008}), kTick);
    EXPECT_TRUE(has(contact.notes, ContactNote::sweep_truncated));
    EXPECT_EQ(contact.proxy.position, before.position);
    EXPECT_NEAR(contact.wrench.force.z(), 1, 1e-9);
  }
  plate.dull = false;
  for (int i = 0; i < 20; ++i) (void)proxy.step(plate, pose_at({0, 0, 0.008 + 1e-3 * i}), kTick);
  EXPECT_FALSE(proxy.step(plate, pose_at({0, 0, 0.03}), kTick).touching);
}

// Fog lies under a tool that comes down in free air: it stops where its middle would go in, where
// this field first doubts, and never goes back up.
TEST(ToolHeld, StopsWhereTheUnknownBegins) {
  DullPlateField plate;
  plate.dull = true;
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.02, 0.02}, 5e-3));
  int stopped = 0;
  double rise = 0;
  proxy.reset(pose_at({0, 0, 0.1}));
  for (int i = 0; i < 100; ++i) {
    const Pose before = proxy.pose();
    const ToolContact contact = proxy.step(plate, pose_at({0, 0, 0.1005 - 1e-3 * i}), kTick);
    stopped += has(contact.notes, ContactNote::sweep_truncated) ? 1 : 0;
    if (i > 0) rise = std::max(rise, contact.proxy.position.z() - before.position.z());
  }
  EXPECT_GE(stopped, 15);
  EXPECT_LE(rise, 0);
  EXPECT_NEAR(proxy.pose().position.z(), 0.02, 1e-3);
}

}  // namespace
}  // namespace palpate::test
