// A hand that presses into acute creases: the proxy stays on its side, and its force turns no
// farther than the crease's faces ask for.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "palpate/contact/proxy.hpp"
#include "support/effort.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kCreaseRadius = 5e-3;
constexpr double kCreaseStiffness = 500;  // N/m
constexpr double kPressDepth = 8e-3;      // of the hand, at most, m

enum class CreaseLook { exact, noisy, uneven };  // uneven: the second sheet has a smaller R

Sampling sampled(CreaseLook look, bool second = false) {
  Sampling sampling{.spacing = 2e-3, .radius = kCreaseRadius, .jitter = 0.2};
  if (look == CreaseLook::noisy) sampling.noise = sampling.tilt = 0.1;
  if (look == CreaseLook::uneven && second) sampling.radius *= 0.8;
  return sampling;
}

/// A floor and a wall, free between them.
std::vector<TestPoint> crease(CreaseLook look, double angle) {
  std::vector<TestPoint> points = wedge(sampled(look), angle, 30e-3);
  const Vector3d wall(std::sin(angle), 0, -std::cos(angle));
  for (TestPoint& p : points) {
    if (p.normal.dot(wall) > 0.9) p.radius = sampled(look, true).radius;
  }
  return points;
}

/// What a hand met on its way.
struct Pressed {
  double deepest = 0;  // of the proxy, behind the true surface, m
  double turn = 0;     // of the force from one tick to the next, rad
  double jump = 0;     // of the force, N
  int touching = 0;    // ticks
  int lost = 0;        // ticks
};

/// Straight ways at 0.1 m/s from `start` to places that `goal` draws; `depth` says how far behind
/// the true surface a place is.
template <class Goal, class Depth>
Pressed press(PointField& points, const Vector3d& start, unsigned seed, int ticks, const Goal& goal,
              const Depth& depth) {
  std::mt19937 random(seed);
  Proxy proxy({.stiffness = kCreaseStiffness});
  proxy.reset(start);
  Vector3d hip = start;
  Vector3d next = start;
  Vector3d before = Vector3d::Zero();
  Pressed found;
  for (int i = 0; i < ticks; ++i) {
    if ((next - hip).norm() < 1e-9) next = goal(random);
    const Vector3d way = next - hip;
    hip += way * std::min(1.0, 1e-4 / way.norm());
    const Contact contact = proxy.step(points.at(hip, proxy), hip, kTick);
    found.deepest = std::max(found.deepest, depth(contact.proxy));
    found.jump = std::max(found.jump, (contact.force - before).norm());
    if (std::min(contact.force.norm(), before.norm()) > 0.5) {
      const double cosine = contact.force.normalized().dot(before.normalized());
      found.turn = std::max(found.turn, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    before = contact.force;
    if (contact.touching) ++found.touching;
    if (has(contact.notes, ContactNote::lost)) ++found.lost;
  }
  return found;
}

/// A right angle's surface lies 0.13 R behind its sheets, as it is rounded.
void expect_held(const Pressed& found, double degrees, unsigned seed) {
  EXPECT_LT(found.deepest, 0.15 * kCreaseRadius) << degrees << " degrees, seed " << seed;
  EXPECT_EQ(found.lost, 0) << degrees << " degrees, seed " << seed;
  EXPECT_LT(found.turn, std::numbers::pi / 2) << degrees << " degrees, seed " << seed;
  EXPECT_LT(found.jump, kCreaseStiffness * kPressDepth) << degrees << " degrees, seed " << seed;
}

struct CreaseCase {
  FieldOptions::Kind kind;
  CreaseLook look;
};

class AcuteCrease : public testing::TestWithParam<CreaseCase> {};

// Enough to get there, and a while.
int steps_of_a_press() {
  return std::max(2000, effort(4000));
}

double between(std::mt19937& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

TEST_P(AcuteCrease, AHandNeverGetsBehindASheet) {
  const auto [kind, look] = GetParam();
  for (const double degrees : {20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    PointField points(crease(look, angle), {.kind = kind});
    const auto behind = [&](const Vector3d& x) {
      return -std::min(x.z(), std::sin(angle) * x.x() - std::cos(angle) * x.z());
    };
    // Into either sheet, or past the crease.
    const auto goal = [&](std::mt19937& random) -> Vector3d {
      const double out = between(random, 0, 1) < 0.3 ? 0 : between(random, 0, 25e-3);
      const double at = between(random, 0, angle);
      const double way = between(random, 0, 2 * std::numbers::pi);
      const double deep = between(random, 0, kPressDepth);
      const double y = between(random, -15e-3, 15e-3);
      return {out * std::cos(at) + deep * std::cos(way), y,
              out * std::sin(at) + deep * std::sin(way)};
    };
    const Vector3d start(30e-3 * std::cos(angle / 2), 0, 30e-3 * std::sin(angle / 2));
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Pressed found = press(points, start, seed, steps_of_a_press(), goal, behind);
      expect_held(found, degrees, seed);
      EXPECT_GT(found.touching, steps_of_a_press() / 20);
    }
  }
}

/// Two balls of 40 mm whose surfaces meet at `angle`, free between them; their middle is the
/// origin. What is inside of the other is left out, as a scan would not see it, and so is what is
/// far from the hand.
struct Twins {
  double rho = 40e-3;
  double apart = 0;  // of each from the origin along x, m

  explicit Twins(double angle) : apart(rho * std::cos(angle / 2)) {}

  [[nodiscard]] double inside(const Vector3d& x) const {
    const Vector3d center(x.x() < 0 ? -apart : apart, 0, 0);
    return rho - (x - center).norm();
  }
  [[nodiscard]] std::vector<TestPoint> points(CreaseLook look) const {
    std::vector<TestPoint> all;
    for (const double side : {-1.0, 1.0}) {
      for (TestPoint p : ball(sampled(look, side > 0), rho)) {
        p.position.x() += side * apart;
        const bool near = p.position.z() > -5e-3 && std::abs(p.position.y()) < 35e-3;
        if (side * p.position.x() > 0 && near) all.push_back(p);
      }
    }
    return all;
  }
};

TEST_P(AcuteCrease, AHandNeverGetsIntoAClosedObject) {
  const auto [kind, look] = GetParam();
  for (const double degrees : {20.0, 40.0, 60.0, 90.0}) {
    const Twins twins(degrees * std::numbers::pi / 180);
    PointField points(twins.points(look), {.kind = kind});
    const double waist = twins.rho * std::sin(degrees * std::numbers::pi / 360);
    const double depth =
        std::min(kPressDepth, 0.5 * waist);  // far from where a neck has another side
    const auto goal = [&](std::mt19937& random) -> Vector3d {
      const double x = between(random, -depth, depth);
      const double angle = between(random, -0.5, 0.5);
      const double out = waist + between(random, -depth, depth);
      return {x, out * std::sin(angle), out * std::cos(angle)};
    };
    const auto inside = [&](const Vector3d& x) { return twins.inside(x); };
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Pressed found = press(points, {0, 0, 50e-3}, seed, steps_of_a_press(), goal, inside);
      expect_held(found, degrees, seed);
      EXPECT_GT(found.touching, steps_of_a_press() / 20);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, AcuteCrease,
    testing::Values(CreaseCase{FieldOptions::Kind::balanced, CreaseLook::exact},
                    CreaseCase{FieldOptions::Kind::balanced, CreaseLook::noisy},
                    CreaseCase{FieldOptions::Kind::balanced, CreaseLook::uneven},
                    CreaseCase{FieldOptions::Kind::pointset, CreaseLook::exact},
                    CreaseCase{FieldOptions::Kind::pointset, CreaseLook::noisy},
                    CreaseCase{FieldOptions::Kind::pointset, CreaseLook::uneven}));

}  // namespace
}  // namespace palpate::test
