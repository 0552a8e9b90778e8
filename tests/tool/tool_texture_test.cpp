// Texture under the samples of a tool (docs/method.md 3.7, 4.2).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/numbers.hpp"
#include "contact/probe.hpp"
#include "palpate/base/error.hpp"
#include "palpate/field/analytic.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// Smooth under a hand that is 3 mm deep: wavelength^2 / (40 depth).
constexpr Texture kGrain{.amplitude = 1e-4, .wavelength = 4e-3};
// Twenty times as deep as that: a hand that is dragged falls from grain to grain.
constexpr Texture kSteep{.amplitude = 1.7e-4, .wavelength = 1e-3};

ToolOptions carved(const Texture& texture) {
  ToolOptions options = kOptions;
  options.texture = texture;
  return options;
}

Tool point() {
  return Tool({{{0, 0, 0}, 0, 0}});
}

/// The least gap of a sample over a plane with its relief, m.
double gap_over_plane(const ToolProxy& proxy, const Texture& texture) {
  double least = std::numeric_limits<double>::infinity();
  for (const Tool::Point& each : proxy.tool().samples()) {
    const Vector3d x = proxy.tool().in_world(each.position, each.side, proxy.pose());
    least = std::min(least, x.z() - relief_at(texture, x).height - each.radius);
  }
  return least;
}

// The force is K times the way to a point of the relief, along its normal there: the closest one.
TEST(ToolTexture, APointFeelsTheReliefsNormal) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(point(), carved(kGrain));
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Vector3d hand(0.02 * random.uniform(), 0.02 * random.uniform(), -0.003);
    const ToolContact contact =
        press(proxy, plane, pose_at(hand + Vector3d(0, 0, 0.01)), pose_at(hand));
    const Vector3d at = contact.proxy.position;
    const Vector3d normal = Vector3d::UnitZ() - relief_at(kGrain, at).gradient;
    const double depth = relief_at(kGrain, at).height - hand.z();
    EXPECT_LT((contact.wrench.force - kStiffness * depth / normal.z() * normal).norm(), 5e-6);
    EXPECT_LT(contact.wrench.torque.norm(), 1e-12);
  }
}

/// The largest difference of forces between a tool of one ball and the proxy of a point with its
/// radius (m), once the hand rests, N; `moving`: on the way between.
double difference_to_proxy(double radius, double& moving) {
  const PlaneField plane;
  const PlaneField pushed_out({.tool_radius = radius});
  ToolProxy six = proxy_of(Tool({{{0, 0, 0}, radius, 0}}), carved(kGrain));
  Proxy three({.texture = kGrain, .tangent_tolerance = 1e-6});
  double resting = 0;
  for (int stop = 0; stop < 20; ++stop) {
    for (int i = 0; i < 300; ++i) {
      const double t = stop + std::min(i, 200) / 200.;
      const Vector3d hand(0.01 * t, 0.02 * std::sin(t), radius + 0.001 - 0.004 * std::min(t, 1.));
      const ToolContact contact = six.step(plane, pose_at(hand, {0.3 * t, 0, 0}), kTick);
      const Contact point = three.step(pushed_out, hand, kTick);
      const double off = (contact.wrench.force - point.force).norm();
      moving = std::max(moving, off);
      if (i == 299) resting = std::max(resting, off);
    }
  }
  return resting;
}

// Both end within nanometres of the closest point; in motion a tool ends its steps earlier.
TEST(ToolTexture, APointAndABallAreTheProxyOfAPoint) {
  for (const double radius : {0.0, 0.003}) {
    double moving = 0;
    EXPECT_LT(difference_to_proxy(radius, moving), 1e-5) << radius;
    EXPECT_LT(moving, 0.03) << radius;
  }
}

TEST(ToolTexture, NoAmplitudeChangesNoBit) {
  const TorusField torus(0.05, 0.02);
  const Tool box = Tool::box({0.02, 0.03, 0.01}, 0.005);
  ToolProxy without = proxy_of(box);
  ToolProxy none = proxy_of(box, {.texture = {.amplitude = 0, .wavelength = 1e-4}});
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = kTick * i;
    const Pose hand =
        pose_at({0.05 * std::cos(3 * t), 0.05 * std::sin(3 * t), 0.024}, {t, 0, 2 * t});
    const ToolContact a = without.step(torus, hand, kTick);
    const ToolContact b = none.step(torus, hand, kTick);
    EXPECT_EQ(a.wrench.force, b.wrench.force);
    EXPECT_EQ(a.wrench.torque, b.wrench.torque);
    EXPECT_EQ(a.evaluations, b.evaluations);
    touching += a.touching ? 1 : 0;
  }
  EXPECT_GT(touching, 500);
}

/// What a hand gets that goes in a circle of 10 mm on a plane and sways, and between which forces.
struct Lap {
  double given = 0;                                        // J
  double least = std::numeric_limits<double>::infinity();  // N
  double most = 0;
};

Lap go_round(ToolProxy& proxy, double height, int ticks) {
  const PlaneField plane;
  const auto hand_at = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / ticks;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return pose_at({0.01 * c, 0.01 * s, height - 0.003}, {0.05 * s, 0.05 * (1 - c), 0.3 * s});
  };
  const Pose start = hand_at(0);
  Pose above = start;
  above.position.z() += 0.01;
  Wrench before = press(proxy, plane, above, start, 500).wrench;
  Lap lap;
  for (int i = 1; i <= ticks; ++i) {
    const Pose from = hand_at(i - 1);
    const Pose to = hand_at(i);
    const Wrench now = proxy.step(plane, to, kTick).wrench;
    lap.given +=
        0.5 * ((before.force + now.force).dot(to.position - from.position) +
               (before.torque + now.torque).dot(turn_between(from.orientation, to.orientation)));
    lap.least = std::min(lap.least, now.force.norm());
    lap.most = std::max(lap.most, now.force.norm());
    before = now;
  }
  return lap;
}

// Carved into the surface a relief keeps what it is given, and a hand feels its grains.
TEST(ToolTexture, GivesNoEnergyAroundALoop) {
  for (const double spacing : {2e-3, 5e-3}) {
    ToolProxy box = proxy_of(Tool::box({0.02, 0.03, 0.01}, spacing), carved(kGrain));
    const Lap lap = go_round(box, 0.005, 1200);
    EXPECT_LE(lap.given, 0) << spacing;
    EXPECT_GT(lap.given, -3e-4) << spacing;
    EXPECT_GT(lap.most - lap.least, 0.01) << spacing;
  }
  ToolProxy one = proxy_of(point(), carved(kGrain));
  const Lap lap = go_round(one, 0, 1200);
  EXPECT_LE(lap.given, 0);
  EXPECT_GT(lap.given, -1e-4);
  EXPECT_GT(lap.most - lap.least, 0.3 * kStiffness * kGrain.amplitude);
}

// Where grains are too steep to follow, what a hand does to get over them is lost and never given.
TEST(ToolTexture, OfTooSteepGrainsOnlyTakes) {
  for (const double fast : {0.05, 0.3}) {
    const int ticks = static_cast<int>(2 * std::numbers::pi * 0.01 / fast / kTick);
    ToolProxy box = proxy_of(Tool::box({0.02, 0.03, 0.01}, 2e-3), carved(kSteep));
    EXPECT_LT(go_round(box, 0.005, ticks).given, 0) << fast;
    EXPECT_GT(gap_over_plane(box, kSteep), -0.01 * kSupport) << fast;
  }
}

// What is known of gaps holds for the relief, too: no sample sinks in unseen while the tool swings
// over the surface, touches it and leaves it.
TEST(ToolTexture, NoSampleSinksInUnseen) {
  const PlaneField plane;
  for (const Texture& texture : {kGrain, kSteep, Texture{2e-3, 8e-3}}) {
    for (Tool& tool : four_tools()) {
      ToolProxy proxy = proxy_of(std::move(tool), carved(texture));
      double least = 0;
      int touching = 0;
      for (int i = 0; i < 4000; ++i) {
        const double t = kTick * i;
        const Pose hand = pose_at(
            {0.05 * std::sin(3 * t), 0.04 * std::sin(2 * t), 0.04 + 0.045 * std::cos(7 * t)},
            {0.3 * std::sin(4 * t), 0.2 * std::cos(3 * t), t}, 0.01);
        touching += proxy.step(plane, hand, kTick).touching ? 1 : 0;
        least = std::min(least, gap_over_plane(proxy, texture));
      }
      EXPECT_GT(least, -0.01 * kSupport) << texture.amplitude;
      EXPECT_GT(touching, 300) << texture.amplitude;
      EXPECT_LT(touching, 3900) << texture.amplitude;
    }
  }
}

// Deeper than 0.28 of its wavelength a relief folds over: it has places without a slope, and what
// is in a fold is held. That is no fault, and the hand comes out.
TEST(ToolTexture, AFoldedReliefIsNoFault) {
  const PlaneField plane;
  for (Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(std::move(tool), carved({.amplitude = 1e-3, .wavelength = 1e-3}));
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
      const double t = kTick * i;
      const Pose hand =
          pose_at({0.02 * std::sin(3 * t), 0.02 * std::sin(2 * t), 0.04 + 0.045 * std::cos(7 * t)},
                  {0, 0, t}, 0.01);
      const ToolContact contact = proxy.step(plane, hand, kTick);
      ASSERT_FALSE(has(contact.notes, ContactNote::fault));
      touching += contact.touching ? 1 : 0;
    }
    EXPECT_GT(touching, 300);
    const Pose away = pose_at({0, 0, 0.2}, {0, 0, 3}, 0.01);
    for (int i = 0; i < 3000; ++i) (void)proxy.step(plane, away, kTick);
    EXPECT_LT((proxy.pose().position - away.position).norm(), 1e-9);
  }
}

// A page's sliders change it under a hand: the tool goes to the bottom of another relief.
TEST(ToolTexture, ChangesUnderATool) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 2e-3), kOptions);
  const Pose hand = pose_at({0.003, 0.001, 0.002});
  const double smooth = press(proxy, plane, pose_at({0.003, 0.001, 0.02}), hand).wrench.force.z();
  proxy.change(kStiffness, {}, kGrain);
  EXPECT_EQ(proxy.options().texture.amplitude, kGrain.amplitude);
  ToolContact contact;
  for (int i = 0; i < 100; ++i) contact = proxy.step(plane, hand, kTick);
  EXPECT_LT(contact.wrench.force.z(), smooth - 1e-3);
  EXPECT_GT(contact.wrench.force.z(), smooth - 2 * kStiffness * kGrain.amplitude);
  EXPECT_NEAR(gap_over_plane(proxy, kGrain), 0, 1e-8);
  proxy.change(kStiffness, {}, {});
  for (int i = 0; i < 100; ++i) contact = proxy.step(plane, hand, kTick);
  EXPECT_NEAR(gap_over_plane(proxy, {}), 0, 1e-8);
  EXPECT_LE(contact.wrench.force.z(), smooth + 1e-6);
}

TEST(ToolTexture, RefusesWhatIsNoTexture) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Texture& bad :
       {Texture{-1e-4, 4e-3}, Texture{kNan, 4e-3}, Texture{0, 0}, Texture{0, kNan}}) {
    EXPECT_THROW(proxy_of(point(), carved(bad)), Error);
  }
}

}  // namespace
}  // namespace palpate::test
