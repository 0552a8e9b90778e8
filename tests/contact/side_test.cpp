// A proxy does not pass between points that it did not touch, whatever a field says; and where the
// field is right, nobody feels that this is watched.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <string>

#include "palpate/contact/proxy.hpp"
#include "support/effort.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"
#include "support/random_hand.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 10e-3;  // R of Sampling, m
constexpr double kLow = 12e-3;     // that hands go to, m

/// Another field's points, of which it sees or says something else.
class Altered : public Field {
 public:
  const Field* whole = nullptr;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    return whole->sample(x);
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return whole->is_free(ball);
  }
  [[nodiscard]] Surface surface(const Vector3d& x) const noexcept override {
    return whole->surface(x);
  }
  [[nodiscard]] Traits traits() const noexcept override { return whole->traits(); }
  [[nodiscard]] Nearby nearby(const Vector3d& x, const Vector3d& up) const noexcept override {
    return whole->nearby(x, up);
  }
  void begin_step() const noexcept override { whole->begin_step(); }
  [[nodiscard]] int points_summed() const noexcept override { return whole->points_summed(); }
  void end_step(const Vector3d& proxy, const Vector3d& normal) const noexcept override {
    whole->end_step(proxy, normal);
  }
};

/// Says that all is free.
class Liar final : public Altered {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    Sample sample = whole->sample(x);
    sample.value = 0.35 * kRadius;
    sample.gradient.setZero();
    return sample;
  }
};

/// Does not say where points are.
class Blind final : public Altered {
 public:
  [[nodiscard]] Nearby nearby(const Vector3d&, const Vector3d&) const noexcept override {
    return {};
  }
};

/// Where a proxy is, and its force, that follows a hand straight from `from` to `to` and half way
/// back.
struct Ends {
  Vector3d deepest;
  Vector3d force;
  Vector3d at_last;
};

Ends follow(PointField& points, const Vector3d& from, const Vector3d& to, double step) {
  Liar liar;
  Proxy proxy;
  proxy.reset(from);
  Ends ends;
  const auto go = [&](const Vector3d& begin, const Vector3d& end) {
    const int ticks = static_cast<int>((end - begin).norm() / step) + 1;
    Contact contact;
    for (int k = 1; k <= ticks; ++k) {
      const Vector3d hand = begin + (end - begin) * k / ticks;
      liar.whole = &points.at(hand, proxy.position());
      contact = proxy.step(liar, hand, kTick);
    }
    return contact;
  };
  const Contact deep = go(from, to);
  ends.deepest = deep.proxy;
  ends.force = deep.force;
  ends.at_last = go(to, from).proxy;
  return ends;
}

TEST(Side, AProxyDoesNotPassBetweenPointsThatAFieldCallsFree) {
  for (const double jitter : {0.0, 0.25}) {
    PointField points(sheet({.jitter = jitter}, 60e-3));
    for (const double step : {1e-5, 2e-4, 2e-3}) {
      for (const double x : {0.0, 1e-3, 2e-3}) {
        for (const double side : {1.0, -1.0}) {
          const Vector3d from(x, 0.5 * x, 2.5 * side * kRadius);
          const Ends ends = follow(points, from, {x, 0.5 * x, -side * kLow}, step);
          const std::string how = "jitter " + std::to_string(jitter) + ", step " +
                                  std::to_string(step) + " m, x " + std::to_string(x);
          EXPECT_GT(side * ends.deepest.z(), 0) << how;
          EXPECT_GT(side * ends.force.z(), 0.1) << how;
          EXPECT_LT((ends.at_last - from).norm(), 1e-12) << how << ": it is free again";
        }
      }
    }
  }
}

int ticks_that_differ(const std::vector<TestPoint>& shape, const Vector3d& start, unsigned seed) {
  PointField points(shape);
  PointField same(shape);
  Blind blind;
  Proxy seeing;
  Proxy unseeing;
  seeing.reset(start);
  unseeing.reset(start);
  RandomHand hand(seed, 0.045);
  int differ = 0;
  for (int k = 0; k < effort(4000); ++k) {
    const Vector3d at = k == 0 ? start : hand.next();
    const Vector3d force = seeing.step(points.at(at, seeing.position()), at, kTick).force;
    blind.whole = &same.at(at, unseeing.position());
    if ((force - unseeing.step(blind, at, kTick).force).norm() > 1e-6) ++differ;
  }
  return differ;
}

TEST(Side, NobodyFeelsItWhereTheFieldIsRight) {
  const Vector3d above(0, 0, 0.09);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    for (const double noise : {0.0, 0.1, 0.25}) {
      const Sampling sampling{.jitter = 0.2, .noise = noise, .tilt = noise, .seed = seed};
      EXPECT_EQ(ticks_that_differ(ball(sampling, 0.04), above, seed), 0) << "ball, noise " << noise;
      EXPECT_EQ(ticks_that_differ(sheet(sampling, 0.1), above, seed), 0) << "sheet, " << noise;
      EXPECT_EQ(ticks_that_differ(plate(sampling, 0.1, 0.02), above, seed), 0) << "plate " << noise;
      for (const double degrees : {60.0, 90.0, 120.0}) {
        const double angle = degrees / 180 * std::numbers::pi;
        // In the apex of an acute crease a hand that is far behind it is held for some ticks more.
        const int most = degrees < 90 ? effort(10) : 0;
        EXPECT_LE(ticks_that_differ(wedge(sampling, angle, 0.06), above, seed), most)
            << degrees << " degrees, noise " << noise;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
