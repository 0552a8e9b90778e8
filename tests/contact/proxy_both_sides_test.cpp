// Sheets are solid behind the side that the hand comes from, whatever their normals' signs are.
#include <gtest/gtest.h>

#include <random>

#include "contact/drive.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// A hand and its proxy at a sheet of 8 cm in the plane z = 0, R = 10 mm.
class Hand {
 public:
  explicit Hand(const Vector3d& start) : hip_(start) { proxy_.reset(start); }

  /// In a straight line at `speed` (m/s). Returns the last step.
  Contact to(const Vector3d& goal, double speed = 0.1) {
    const Vector3d start = hip_;
    const int steps =
        std::max(1, static_cast<int>(std::ceil((goal - start).norm() / (speed * kTick))));
    Contact contact;
    for (int i = 1; i <= steps; ++i) {
      hip_ = start + (goal - start) * (static_cast<double>(i) / steps);
      contact = proxy_.step(points_.at(hip_, proxy_), hip_, kTick);
    }
    return contact;
  }

 private:
  PointField points_{sheet({}, 0.04)};
  Proxy proxy_;
  Vector3d hip_;
};

TEST(BothSides, AreTouchedFromWhereTheHandComes) {
  for (const double side : {1.0, -1.0}) {
    Hand hand({0.01, 0, 0.03 * side});
    EXPECT_EQ(hand.to({0.01, 0, 0.001 * side}).force.norm(), 0);
    for (double depth = 1e-3; depth < 20e-3; depth += 1e-3) {
      EXPECT_NEAR(hand.to({0.01, 0, -depth * side}).force.z(), 500 * side * depth, 1e-3);
    }
  }
}

TEST(BothSides, AFastHandIsStopped) {
  for (int phase = 0; phase < 20; ++phase) {
    Hand hand({0, 0, 0.0501 + 1e-3 * phase});
    EXPECT_NEAR(hand.to({0, 0, -0.03}, 5.0).force.z(), 15, 1e-3);
  }
}

TEST(BothSides, WhoeverGoesRoundTheEdgeMeetsTheOtherOne) {
  Hand hand({0, 0, 0.03});
  EXPECT_NEAR(hand.to({0, 0, -0.003}).force.z(), 1.5, 1e-3);
  hand.to({0, 0, 0.03});
  hand.to({0.08, 0, 0.03});
  hand.to({0.08, 0, -0.03});
  hand.to({0, 0, -0.03});
  EXPECT_NEAR(hand.to({0, 0, 0.003}).force.z(), -1.5, 1e-3);
}

TEST(BothSides, AHandThatStartsCloseBehindIsNotKicked) {
  Hand hand({0, 0, -0.002});
  EXPECT_EQ(hand.to({0, 0, -0.002}).force.norm(), 0);
  EXPECT_NEAR(hand.to({0, 0, 0.002}).force.z(), -1, 1e-3);
}

TEST(BothSides, SignsOfGivenNormalsAreNotFelt) {
  const std::vector<TestPoint> sphere = ball({}, 0.03);
  std::vector<std::vector<Vector3d>> forces;
  for (const double turned : {0.0, 0.02, 0.35, 0.5, 1.0}) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    PointCloud cloud;
    for (const TestPoint& p : sphere) {
      cloud.positions.push_back(p.position.cast<float>());
      cloud.normals.push_back((uniform(random) < turned ? -1 : 1) * p.normal.cast<float>());
    }
    Scene scene;
    scene.add("sphere", cloud);
    SceneField field(scene);
    Proxy proxy;
    Vector3d hip(0, 0, 0.06);
    proxy.reset(hip);
    forces.emplace_back();
    for (int i = 0; i < 4000; ++i) {
      const double t = 1e-3 * i;
      hip = (0.045 + 0.02 * std::cos(5 * t)) *
            Vector3d(std::sin(2 * t), std::sin(3 * t) * std::cos(2 * t), std::cos(2 * t));
      field.update(t, hip, proxy);
      forces.back().push_back(proxy.step(field, hip, kTick).force);
    }
    EXPECT_TRUE(forces.front() == forces.back()) << turned << " are turned";
  }
  double most = 0;
  for (const Vector3d& force : forces.front()) most = std::max(most, force.norm());
  EXPECT_GT(most, 2);
}

}  // namespace
}  // namespace palpate::test
