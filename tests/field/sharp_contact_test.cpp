// A proxy on surfaces with sharp edges (docs/method.md 2.8).
#include <gtest/gtest.h>

#include <numbers>

#include "field/edged_shapes.hpp"
#include "palpate/contact/proxy.hpp"
#include "support/effort.hpp"
#include "support/point_field.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kStiffness = 500;  // N/m

Proxy proxy_at(const Vector3d& place) {
  Proxy proxy({.stiffness = kStiffness});
  proxy.reset(place);
  return proxy;
}

/// Straight ways at 0.1 m/s from the first place through all others; the contact of every tick.
std::vector<Contact> follow(PointField& points, const std::vector<Vector3d>& places) {
  Proxy proxy = proxy_at(places.front());
  std::vector<Contact> contacts;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Vector3d way = places[i] - places[i - 1];
    const int ticks = std::max(1, static_cast<int>(way.norm() / 0.1 / kTick));
    for (int k = 1; k <= ticks; ++k) {
      const Vector3d hip = places[i - 1] + way * (static_cast<double>(k) / ticks);
      contacts.push_back(proxy.step(points.at(hip, proxy), hip, kTick));
    }
  }
  return contacts;
}

TEST(SharpContact, CreasesHoldAHandInBothFaces) {
  PointField sharp(wedge(fine(), std::numbers::pi / 2, 30e-3), {}, true);
  for (const double depth : {3e-3, 6e-3, 10e-3}) {
    const auto at = [&](double out, double along) { return Vector3d(out, along, out); };
    const std::vector<Vector3d> path{at(20e-3, -10e-3), at(-depth, -10e-3), at(-depth, 10e-3)};
    const auto contacts = follow(sharp, path);
    const auto pressing = static_cast<std::size_t>(30e-3 / 0.1 / kTick);
    const Vector3d right = kStiffness * Vector3d(depth, 0, depth);
    ASSERT_GT(contacts.size(), pressing + 150);
    for (std::size_t i = pressing + 150; i < contacts.size(); ++i) {
      EXPECT_LT((contacts[i].force - right).norm(), 0.15) << depth;
    }
  }
}

// Without sheets, both sides of a thin plate are one surface, which lies up to 0.2 R before them.
TEST(SharpContact, PlatesOfAnyThicknessHold) {
  for (const double thickness : {1e-3, 2e-3, 4e-3, 8e-3, 16e-3}) {
    PointField points(plate(fine(), 24e-3, thickness), {}, true);
    const auto contacts = follow(points, {{0, 0, 10e-3}, {0, 0, -20e-3}, {2e-3, 1e-3, -20e-3}});
    EXPECT_GT(contacts.back().force.z(), 9) << thickness;
    EXPECT_NEAR(contacts.back().proxy.z(), 0, 0.21 * fine().radius) << thickness;
  }
}

TEST(SharpContact, AHandThatSlidesOverTheEdgeFeelsTwoFaces) {
  const auto points = ridge(fine(10e-3), 30e-3);
  const std::vector<Vector3d> path{{-25e-3, 0, 5e-3}, {-25e-3, 0, -3e-3}, {5e-3, 0, -3e-3}};
  const auto tilted = [&](bool sharp_edges) {
    PointField field(points, {}, sharp_edges);
    int count = 0;
    for (const Contact& contact : follow(field, path)) {
      const Vector3d n = contact.force.normalized();
      if (contact.touching && std::max(n.x(), n.z()) < std::cos(0.1)) ++count;
    }
    return count;
  };
  EXPECT_LT(tilted(true), 0.4 * tilted(false));
}

/// Work that the second of two laps around the edge gives to the hand, J.
double second_lap(PointField& points, const Vector3d& center, double radius, double speed) {
  const int ticks = static_cast<int>(2 * std::numbers::pi * radius / speed / kTick);
  const auto at = [&](int tick) -> Vector3d {
    const double angle = 2 * std::numbers::pi * tick / ticks;
    return center + radius * Vector3d(std::sin(angle), 0, std::cos(angle));
  };
  Proxy proxy = proxy_at(at(0) + Vector3d(0, 0, 15e-3));
  for (int i = 150; i > 0; --i) {
    const Vector3d hip = at(0) + Vector3d(0, 0, i * 1e-4);
    (void)proxy.step(points.at(hip, proxy), hip, kTick);
  }
  double given = 0;
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i <= 2 * ticks; ++i) {
    const Vector3d hip = at(i);
    const Contact contact = proxy.step(points.at(hip, proxy), hip, kTick);
    if (i > ticks) given += 0.5 * (before + contact.force).dot(hip - at(i - 1));
    before = contact.force;
  }
  return given;
}

TEST(SharpContact, LoopsAroundTheEdgeGiveNothing) {
  PointField points(ridge(fine(10e-3), 30e-3), {}, true);
  for (const double speed : {0.05, 0.2, 1.0}) {
    for (const double radius : {4e-3, 8e-3, 12e-3}) {
      for (const double inside : {0.0, 2e-3, 5e-3}) {
        const Vector3d center(-inside, 0.4e-3, -inside);
        EXPECT_LE(second_lap(points, center, radius, speed), 0.05e-3)
            << "radius " << radius << ", speed " << speed << ", inside " << inside;
      }
    }
  }
}

struct FuzzScene {
  const char* name;
  std::vector<TestPoint> points;
};

std::vector<FuzzScene> fuzz_scenes() {
  Sampling noisy = fine();
  noisy.jitter = 0.2;
  noisy.noise = 0.03;
  noisy.tilt = 0.03;
  return {{"box", box(fine(), {16e-3, 12e-3, 10e-3})},
          {"noisy box", box(noisy, {16e-3, 12e-3, 10e-3})},
          {"ridge", ridge(noisy, 20e-3)},
          {"thin box", box(fine(), {16e-3, 16e-3, 2e-3})}};
}

TEST(SharpContact, ARandomHandNeverGetsInside) {
  for (const FuzzScene& scene : fuzz_scenes()) {
    PointField points(scene.points, {}, true);
    int touching = 0;
    int inside = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-30e-3, 30e-3);
      Vector3d hip(0, 0, 50e-3);
      Vector3d goal = hip;
      Proxy proxy = proxy_at(hip);
      for (int i = 0; i < effort(5000); ++i) {
        if ((goal - hip).norm() < 1e-3) goal = {uniform(random), uniform(random), uniform(random)};
        hip += (goal - hip).normalized() * (0.1e-3 + 0.4e-3 * (seed - 1));
        const Field& field = points.at(hip, proxy);
        const Contact contact = proxy.step(field, hip, kTick);
        ASSERT_TRUE(contact.force.allFinite() && contact.proxy.allFinite());
        EXPECT_FALSE(has(contact.notes, ContactNote::lost));
        if (!contact.touching) continue;
        ++touching;
        const Sample here = field.sample(contact.proxy);
        const double depth = -here.value / std::max(here.gradient.norm(), 1e-9) / here.radius;
        if (depth > 0.002) ++inside;
      }
    }
    EXPECT_EQ(inside, 0) << scene.name;
    EXPECT_GT(touching, effort(15000) / 10) << scene.name;
  }
}

}  // namespace
}  // namespace palpate::test
