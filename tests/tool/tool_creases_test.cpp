// A tool between solids that overlap: random hands never bring it inside; turned worlds and second
// runs feel the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "base/numbers.hpp"
#include "palpate/field/analytic.hpp"
#include "support/effort.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// A hand that wanders through and around what is near the origin.
class WanderingHand {
 public:
  explicit WanderingHand(std::uint64_t seed) : random_(seed) {}

  Pose next() {
    const Vector3d home(0.03, 0, 0.02);
    velocity_ += 0.02 * normal() - 0.002 * velocity_ - 0.004 * (pose_.position - home);
    turning_ += 0.3 * normal() - 0.01 * turning_;
    if (count_ % 5000 == 0) velocity_ *= 3;
    if (count_++ % 3000 == 0) pose_.opening = 0.005 + 0.05 * random_.uniform();
    pose_.position += kTick * velocity_;
    pose_.orientation = turned(pose_.orientation, kTick * turning_);
    return pose_;
  }

 private:
  Vector3d normal() {
    const double x = random_.normal();
    const double y = random_.normal();
    return {x, y, random_.normal()};
  }

  Random random_;
  Pose pose_ = pose_at({0, 0, 0.12});
  Vector3d velocity_ = Vector3d::Zero();  // m/s
  Vector3d turning_ = Vector3d::Zero();   // rad/s
  int count_ = 0;
};

/// A ball, a tilted box and a floor that overlap, all of them turned by a rotation.
struct Creases {
  explicit Creases(const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity())
      : world(turn),
        ball(0.04, {.T_world_shape = world}),
        box({0.06, 0.05, 0.04},
            {.T_world_shape = world * Eigen::Translation3d(0.06, 0, 0) *
                              turned(Eigen::Quaterniond::Identity(), {0.3, 0.5, 0})}),
        floor({.T_world_shape = world * Eigen::Translation3d(0, 0, -0.03)}),
        all({&ball, &box, &floor}) {}

  Eigen::Isometry3d world;
  SphereField ball;
  BoxField box;
  PlaneField floor;
  UnionField all;
};

/// How deep a tool was in a field, and in how many ticks it touched.
struct Depths {
  void see(const ToolProxy& proxy, const Field& field, const ToolContact& contact) {
    const double depth = depth_of(proxy, field);
    deepest = std::max(deepest, depth);
    deep += depth > 0.02 * kSupport ? 1 : 0;
    touching += contact.touching ? 1 : 0;
  }
  void expect_outside(int ticks) const {
    EXPECT_EQ(deep, 0) << deepest / kSupport << " R";
    EXPECT_GT(touching, ticks / 10);
  }

  int deep = 0;
  int touching = 0;
  double deepest = 0;
};

TEST(ToolInCreases, NeverEntersCreasesAndNeverIsNaN) {
  const Creases scene;
  const int ticks = effort(25'000);
  std::uint64_t seed = 50;
  for (Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(std::move(tool));
    WanderingHand hand(seed++);
    Depths depths;
    int not_finite = 0;
    int lagging = 0;
    int unfinished = 0;
    int most = 0;
    for (int i = 0; i < ticks; ++i) {
      const ToolContact contact = proxy.step(scene.all, hand.next(), kTick);
      const Wrench& wrench = contact.wrench;
      const bool finite = wrench.force.allFinite() && wrench.torque.allFinite() &&
                          std::isfinite(wrench.grip) && !has(contact.notes, ContactNote::fault);
      not_finite += finite ? 0 : 1;
      depths.see(proxy, scene.all, contact);
      lagging += has(contact.notes, ContactNote::sweep_truncated) ? 1 : 0;
      unfinished += has(contact.notes, ContactNote::not_converged) ? 1 : 0;
      most = std::max(most, contact.evaluations);
    }
    EXPECT_EQ(not_finite, 0);
    depths.expect_outside(ticks);
    EXPECT_LT(lagging, 20 + ticks / 20);
    EXPECT_LT(unfinished, 10 + ticks / 1000);
    EXPECT_LE(most, proxy.max_evaluations());
  }
}

/// A thin sheet z = 0 under which the floor of a hall lies, both of which are exact distances.
struct Hall {
  BoxField sheet{{0.12, 0.12, 0.003}};
  PlaneField floor{{.T_world_shape = Eigen::Isometry3d(Eigen::Translation3d(0, 0, -0.05))}};
  UnionField all{{&sheet, &floor}};
};

// A sheet a third of R thick, from above and from below, past its rims and through the gap under
// it, with fingers that open and close on it.
TEST(ToolInCreases, NeverEntersAThinSheet) {
  const Hall hall;
  const int ticks = effort(25'000);
  std::uint64_t seed = 80;
  for (Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(std::move(tool));
    WanderingHand hand(seed++);
    Depths depths;
    double least_opening = 0;
    for (int i = 0; i < ticks; ++i) {
      Pose pose = hand.next();
      pose.opening = 0.02 * (1 + std::sin(5e-3 * i));
      pose.position.x() += 0.03;
      const ToolContact contact = proxy.step(hall.all, pose, kTick);
      depths.see(proxy, hall.all, contact);
      least_opening = std::min(least_opening, contact.proxy.opening);
    }
    depths.expect_outside(ticks);
    EXPECT_GT(least_opening, -1e-9);
  }
}

TEST(ToolInCreases, FeelsTheSameInATurnedWorld) {
  const Eigen::Quaterniond turn = turned(Eigen::Quaterniond::Identity(), {0.4, -1.1, 0.7});
  const Creases upright;
  const Creases tilted(turn);
  ToolProxy one = proxy_of(Tool::box({0.02, 0.03, 0.01}, 0.005));
  ToolProxy other = proxy_of(Tool::box({0.02, 0.03, 0.01}, 0.005));
  double worst = 0;
  double largest = 0;
  for (int i = 0; i < 3000; ++i) {
    const double t = kTick * i;
    const double height = 0.036 + std::max(0.0, 0.05 - 1e-4 * i);  // comes down first
    const Pose hand = pose_at({0.02 * std::sin(2 * t), 0.01 * std::cos(3 * t), height},
                              {0.3 * std::sin(t), 0.2 * std::sin(2 * t), t});
    Pose same = hand;
    same.position = turn * hand.position;
    same.orientation = turn * hand.orientation;
    const ToolContact a = one.step(upright.all, hand, kTick);
    const ToolContact b = other.step(tilted.all, same, kTick);
    worst = std::max({worst, (turn * a.wrench.force - b.wrench.force).norm(),
                      (turn * a.wrench.torque - b.wrench.torque).norm()});
    largest = std::max(largest, a.wrench.force.norm());
  }
  EXPECT_LT(worst, 1e-8);
  EXPECT_GT(largest, 3);
}

std::vector<std::uint64_t> bits_of_a_run(ToolProxy proxy) {
  const Creases scene;
  WanderingHand hand(5);
  std::vector<std::uint64_t> bits;
  for (int i = 0; i < 5000; ++i) {
    const Wrench wrench = proxy.step(scene.all, hand.next(), kTick).wrench;
    for (int axis = 0; axis < 3; ++axis) {
      bits.push_back(std::bit_cast<std::uint64_t>(wrench.force[axis]));
      bits.push_back(std::bit_cast<std::uint64_t>(wrench.torque[axis]));
    }
    bits.push_back(std::bit_cast<std::uint64_t>(wrench.grip));
  }
  return bits;
}

TEST(ToolInCreases, RepeatsItselfBitForBit) {
  const auto tool = [] { return Tool::gripper({0.006, 0.012, 0.03}, 0.004); };
  const std::vector<std::uint64_t> first = bits_of_a_run(proxy_of(tool()));
  EXPECT_EQ(first, bits_of_a_run(proxy_of(tool())));
  EXPECT_GT(std::ranges::count_if(first, [](auto bits) { return bits << 1 != 0; }), 5000);
}

// At rest the forces of the touches are the wrench.
TEST(ToolInCreases, ItsTouchesAddUpToItsWrench) {
  const Creases scene;
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 0.005));
  const Pose from = pose_at({0.035, 0, 0.1});
  const Pose to = pose_at({0.036, 0.004, 0.018}, {0.3, 0.2, 0.1});
  const ToolContact contact = press(proxy, scene.all, from, to, 200, 3000);
  Wrench sum;
  for (int k = 0; k < contact.touch_count; ++k) {
    const ToolContact::Touch& touch = contact.touches[static_cast<std::size_t>(k)];
    const Vector3d force = touch.force * touch.normal;
    sum.force += force;
    sum.torque += (touch.position - contact.proxy.position).cross(force);
  }
  EXPECT_GE(contact.touch_count, 2);
  EXPECT_GT(contact.wrench.force.norm(), 1);
  EXPECT_LT((sum.force - contact.wrench.force).norm(), 1e-3);
  EXPECT_LT((sum.torque - contact.wrench.torque).norm(), 1e-4);
}

}  // namespace
}  // namespace palpate::test
