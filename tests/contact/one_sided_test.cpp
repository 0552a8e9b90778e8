// What a camera saw from one side alone: solid for a hand in front of it, not there for one behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/drive.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kRho = 12e-3;                          // of the bulge, m
const Sampling kSeen{.spacing = 3e-3, .radius = 8e-3};  // R = 2/3 rho
const Vector3d kOver = Vector3d(0.3e-3, 0.2e-3, 0);     // beside the middle of the bulge
const Vector3d kTop = kOver + Vector3d(0, 0, kRho);     // nearly on it
const Vector3d kDeepInBulge = kOver + Vector3d(0, 0, kRho - 4e-3);  // 4 mm deep

/// The upper half of a ball around the origin, as a camera above sees it.
std::vector<TestPoint> bulge() {
  std::vector<TestPoint> points = ball(kSeen, kRho);
  std::erase_if(points, [](const TestPoint& p) { return p.normal.z() < 0.1; });
  return points;
}

/// A hand at points that were seen from the side of their normals.
class BulgeHand {
 public:
  BulgeHand(const std::vector<TestPoint>& points, const Vector3d& start)
      : points_(points, {}, false, Vector3d(0, 0, 1)), hip_(start) {
    proxy_.reset(start);
  }

  /// In a straight line at 0.1 m/s. Returns the last step.
  Contact to(const Vector3d& goal) {
    const Vector3d start = hip_;
    const int steps = static_cast<int>(std::ceil((goal - start).norm() / (0.1 * kTick)));
    Contact contact;
    for (int i = 1; i <= steps; ++i) {
      hip_ = start + (goal - start) * (static_cast<double>(i) / steps);
      contact = proxy_.step(points_.at(hip_, proxy_), hip_, kTick);
      most_ = std::max(most_, contact.force.norm());
    }
    return contact;
  }
  [[nodiscard]] double most() const { return most_; }  // N

 private:
  PointField points_;
  Proxy proxy_;
  Vector3d hip_;
  double most_ = 0;
};

TEST(OneSided, HoldsAHandFromTheFrontAlone) {
  BulgeHand hand(bulge(), {1e-3, 0, -0.03});
  hand.to({1e-3, 0, kRho + 6e-3});
  EXPECT_EQ(hand.most(), 0) << "from behind, and out in front";
  EXPECT_NEAR(hand.to({1e-3, 0, kRho - 4e-3}).force.norm(), 2, 0.05);
}

TEST(OneSided, AHandThatBeginsCloseAboveABulgeIsInFrontOfIt) {
  for (const double height : {0.2e-3, 0.5e-3, 1e-3, 3e-3}) {
    BulgeHand hand(bulge(), kTop + Vector3d(0, 0, height));
    EXPECT_NEAR(hand.to(kDeepInBulge).force.norm(), 2, 0.02) << height;
  }
}

TEST(OneSided, ABulgeHoldsAHandThatIsBehindALid) {
  for (const double gap : {6e-3, 8e-3, 10e-3}) {
    std::vector<TestPoint> points = bulge();
    const std::vector<TestPoint> lid = sheet(kSeen, 0.03, kRho + gap);
    points.insert(points.end(), lid.begin(), lid.end());
    BulgeHand hand(points, kTop + Vector3d(0, 0, 0.5 * gap));
    EXPECT_NEAR(hand.to(kDeepInBulge).force.norm(), 2, 0.02) << gap;
    EXPECT_GT(hand.to({0.7 * kRho, 0, 0.5 * kRho}).force.norm(), 0.5) << gap;
  }
}

}  // namespace
}  // namespace palpate::test
