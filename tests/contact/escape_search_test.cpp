// A hand in open air is not held from within by a surface that its proxy passed through.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/drive.hpp"
#include "contact/test_fields.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kR = 0.01;  // m
constexpr double kThickness =
    6e-3;  // of walls, m: single sheets of points are solid for more than R / 2

/// Walls of which nothing is known but their distance. While `leaks`, they stop nobody.
class WallsField : public Field {
 public:
  bool leaks = false;
  std::uint64_t revision = 0;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    if (leaks) return {.value = 1, .radius = kR};
    constexpr double kSmall = 1e-7;  // m
    Sample sample{.value = wall(x), .support = 1, .radius = kR};
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kSmall * Vector3d::Unit(axis);
      sample.gradient[axis] = (wall(x + step) - wall(x - step)) / (2 * kSmall);
    }
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return leaks || wall(ball.center) > ball.radius;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Traits traits() const noexcept override {
    return {.resolution = kR / 16, .revision = revision};
  }

 private:
  [[nodiscard]] virtual double wall(const Vector3d& x) const noexcept = 0;
};

/// A hollow ball around the origin.
class HollowBall : public WallsField {
 public:
  static constexpr double kOuter = 0.06;  // m

 private:
  [[nodiscard]] double wall(const Vector3d& x) const noexcept override {
    return std::abs(x.norm() - kOuter + kThickness / 2) - kThickness / 2;
  }
};

/// A hollow ball whose wall is free around its top, as where points have wrong normals, though they
/// weigh there what they weigh anywhere else.
class BallOfWrongNormals final : public HollowBall {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    Sample sample = HollowBall::sample(x);
    sample.support = std::clamp(1 - sample.value / (0.6 * kR), 0.0, 1.0);
    if (x.z() > 0.8 * x.norm()) sample.value = std::abs(sample.value) + 0.1 * kR;
    return sample;
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return HollowBall::is_free({ball.center, ball.radius + 0.4 * kR});
  }
};

/// Two square plates that face each other across a gap, or meet at an edge.
class TwoPlates final : public WallsField {
 public:
  TwoPlates(double gap, double angle) : gap_(gap), angle_(angle) {}

 private:
  [[nodiscard]] static double plate(const Vector3d& x) noexcept {
    const Vector3d half(0.1, 0.1, kThickness / 2);
    const Vector3d off = (x - Vector3d(0.1, 0, 0)).cwiseAbs() - half;
    return off.cwiseMax(0).norm() + std::min(0.0, off.maxCoeff());
  }
  [[nodiscard]] double wall(const Vector3d& x) const noexcept override {
    const double c = std::cos(angle_);
    const double s = std::sin(angle_);
    const Vector3d turned(c * x.x() + s * x.z(), x.y(), c * x.z() - s * x.x());
    return std::min(plate(x), plate(turned - Vector3d(0, 0, gap_)));
  }
  double gap_;
  double angle_;
};

/// An open tube with a bottom, tilted, its walls rough by `rough`.
class Tube final : public WallsField {
 public:
  Tube(double radius, double height, double rough, const Eigen::Matrix3d& rotation)
      : radius_(radius), height_(height), rough_(rough), R_(rotation) {}

 private:
  [[nodiscard]] static double plate(double x, double z, double half_x, double half_z) noexcept {
    const Eigen::Vector2d off(std::abs(x) - half_x, std::abs(z) - half_z);
    return off.cwiseMax(0).norm() + std::min(0.0, off.maxCoeff());
  }
  [[nodiscard]] double wall(const Vector3d& x) const noexcept override {
    constexpr double kHalf = kThickness / 2;
    const Vector3d in = R_.transpose() * x;
    const double aside = in.head<2>().norm();
    const double side = plate(aside - radius_ - kHalf, in.z() - height_ / 2, kHalf, height_ / 2);
    const double bottom = plate(aside, in.z() + kHalf, radius_ + kThickness, kHalf);
    const Vector3d waves = (x / kR * 3).array().sin();
    return std::min(side, bottom) - rough_ * waves.prod() - rough_;
  }
  double radius_;
  double height_;
  double rough_;
  Eigen::Matrix3d R_;
};

struct Outcome {
  double most = 0;  // N
  bool freed = false;
  Contact last;
};

Outcome go(Proxy& proxy, const Field& field, const std::vector<Vector3d>& way, double speed) {
  Outcome outcome;
  for (std::size_t i = 1; i < way.size(); ++i) {
    outcome.last =
        drive(proxy, field, way[i - 1], way[i], speed, [&](const Vector3d&, const Contact& c) {
          outcome.most = std::max(outcome.most, c.force.norm());
          outcome.freed = outcome.freed || has(c.notes, ContactNote::freed);
        });
  }
  return outcome;
}

const Vector3d kOutside(0.02, 0.01, 0.15);
const Vector3d kWithin(0.005, 0, 0);

TEST(EscapeSearch, WhoCameThroughALeakIsLetGoOnTheEscapePath) {
  HollowBall ball;
  Proxy proxy;
  proxy.reset(kOutside);
  ball.leaks = true;
  ASSERT_EQ(go(proxy, ball, {kOutside, kWithin}, 0.1).most, 0);
  ball.leaks = false;
  const Outcome out = go(proxy, ball, {kWithin, kOutside}, 0.1);
  EXPECT_TRUE(out.freed);
  EXPECT_LT(out.most, 500 * 3 * kR);  // 3 R beyond the wall, and not 9
  EXPECT_EQ(out.last.force.norm(), 0);
  EXPECT_EQ(proxy.position(), kOutside);
}

TEST(EscapeSearch, AWallThatLetTheProxyPassIsNoEscape) {
  const BallOfWrongNormals ball;
  Proxy proxy;
  const Vector3d above(0.001, 0.002, 0.15);
  proxy.reset(above);
  ASSERT_EQ(go(proxy, ball, {above, kWithin}, 0.1).most, 0);
  const Outcome out = go(proxy, ball, {kWithin, {0.01, 0, -0.15}}, 0.1);
  EXPECT_TRUE(out.freed);
  EXPECT_LT(out.most, 500 * 4 * kR);
  EXPECT_EQ(out.last.force.norm(), 0);
}

TEST(EscapeSearch, WhoWasNeverOutsideIsHeldByTheWallsOfARoom) {
  const HollowBall ball;
  Proxy proxy;
  proxy.reset(kWithin);
  const Outcome out = go(proxy, ball, {kWithin, {0.02, 0.01, 0.1}}, 0.1);
  EXPECT_FALSE(out.freed);
  EXPECT_NEAR(out.last.force.norm(),
              500 * (Vector3d(0.02, 0.01, 0.1).norm() - HollowBall::kOuter + kThickness), 0.1);
}

TEST(EscapeSearch, ABodyHoldsAHandThatPressesThroughAllOfIt) {
  const HollowBall ball;
  Proxy proxy;
  proxy.reset(kOutside);
  const Outcome out = go(proxy, ball, {kOutside, {0.001, 0.002, -0.03}}, 0.1);
  EXPECT_FALSE(out.freed);
  EXPECT_NEAR(out.last.force.norm(), 500 * (HollowBall::kOuter - 0.03), 0.1);
}

TEST(EscapeSearch, NarrowSlotsAndWedgesHoldAHandThatCameInFromOpenAir) {
  for (const double gap : {0.3 * kR, kR, 2 * kR, 4 * kR}) {
    const TwoPlates slot(gap + kThickness, 0);
    const double middle = 0.5 * (gap + kThickness);
    Proxy proxy;
    const Vector3d outside(-0.1, 0.01, middle);
    proxy.reset(outside);
    const Vector3d place(0.1, -0.02, middle);
    const Outcome out =
        go(proxy, slot, {outside, place, place - Vector3d(0, 0, middle + 2.5 * kR)}, 0.1);
    EXPECT_FALSE(out.freed) << gap;
    EXPECT_NEAR(out.last.force.norm(), 500 * (2.5 * kR + kThickness / 2), 0.5) << gap;
  }
  for (const double degrees : {20., 40., 60., 90.}) {
    const double angle = degrees * std::acos(-1.0) / 180;
    const TwoPlates wedge(0, angle);
    const Vector3d along(std::cos(angle / 2), 0, std::sin(angle / 2));
    Proxy proxy;
    proxy.reset(0.3 * along);
    const Vector3d corner = 0.05 * along;
    const Outcome out = go(proxy, wedge, {0.3 * along, corner, corner - Vector3d(0, 0, 0.06)}, 0.1);
    EXPECT_FALSE(out.freed) << degrees;
    EXPECT_GT(out.last.force.norm(), 500 * 0.02) << degrees;
  }
}

TEST(EscapeSearch, DeepTiltedTubesHoldAHandThatCameInByTheMouth) {
  int tried = 0;
  int freed = 0;
  for (const double radius : {1 * kR, 2 * kR, 4 * kR}) {
    for (const double tilt : {0.0, 0.6}) {
      for (const double rough : {0.0, 0.1 * kR}) {
        for (const double turn : {0.2, 1.3, 2.9}) {
          const Eigen::Matrix3d R = (Eigen::AngleAxisd(0.4, Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(tilt, Vector3d::UnitX()))
                                        .toRotationMatrix();
          const Tube tube(radius, 16 * kR, rough, R);
          const Vector3d above = R * Vector3d(0, 0, 21 * kR);
          const Vector3d within = R * Vector3d(0, 0, 2 * kR);
          const Vector3d side = R * Vector3d(std::cos(turn), std::sin(turn), 0);
          const Vector3d end = within + (radius + 3 * kR) * side;
          Proxy proxy;
          proxy.reset(above);
          Outcome out = go(proxy, tube, {above, within, end}, 0.1);
          for (int i = 0; i < 400; ++i) {
            out.freed = out.freed || has(proxy.step(tube, end, kTick).notes, ContactNote::freed);
          }
          freed += out.freed ? 1 : 0;
          ++tried;
        }
      }
    }
  }
  EXPECT_EQ(freed, 0) << "of " << tried;
}

TEST(EscapeSearch, ASurfaceThatCameAroundAProxyHoldsIt) {
  HollowBall ball;
  Proxy proxy;
  proxy.reset(kOutside);
  ball.leaks = true;
  ASSERT_EQ(go(proxy, ball, {kOutside, kWithin}, 0.1).most, 0);
  ball.leaks = false;
  ++ball.revision;
  EXPECT_FALSE(go(proxy, ball, {kWithin, {0.02, 0.01, 0.1}}, 0.1).freed);
}

}  // namespace
}  // namespace palpate::test
