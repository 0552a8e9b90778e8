// docs/method.md 10: plates that hold, edges that let go, offsets, curvature, friction.
#include <gtest/gtest.h>

#include <numbers>

#include "palpate/contact/proxy.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// What the hand felt on its way.
struct Ride {
  Contact last;
  double most = 0;             // largest force, N
  double last_force = 0;       // before contact ended, N
  double jump = 0;             // largest change of force between two ticks, N
  double jump_in_contact = 0;  // the same, without the tick that ends a contact
  double pull = 0;             // largest force towards -z, N
  double given = 0;            // energy to the hand, J
};

/// Hands its proxy along straight ways.
class Rider {
 public:
  Rider(PointField& points, const Vector3d& start, const ProxyOptions& options = {})
      : points_(points), proxy_(options), hip_(start) {
    proxy_.reset(start);
  }

  Ride to(const Vector3d& goal, double speed = 0.1) {
    Ride ride;
    const Vector3d start = hip_;
    const int steps = std::max(1, static_cast<int>((goal - start).norm() / (speed * kTick)));
    for (int i = 1; i <= steps; ++i) {
      step(start + (goal - start) * (static_cast<double>(i) / steps), ride);
    }
    return ride;
  }

 private:
  void step(const Vector3d& hip, Ride& ride) {
    const Contact c = proxy_.step(points_.at(hip, proxy_), hip, kTick);
    const double jump = (c.force - before_.force).norm();
    ride.jump = std::max(ride.jump, jump);
    if (c.touching) ride.jump_in_contact = std::max(ride.jump_in_contact, jump);
    if (before_.touching && !c.touching) ride.last_force = before_.force.norm();
    ride.most = std::max(ride.most, c.force.norm());
    ride.pull = std::max(ride.pull, -c.force.z());
    ride.given += 0.5 * (c.force + before_.force).dot(hip - hip_);
    ride.last = c;
    before_ = c;
    hip_ = hip;
  }

  PointField& points_;
  Proxy proxy_;
  Vector3d hip_;
  Contact before_;
};

TEST(AcceptancePlate, HoldsTenNewtonWhateverItsThickness) {
  for (const double thickness : {1e-3, 2e-3, 4e-3, 8e-3, 16e-3}) {
    PointField points(plate({}, 0.04, thickness));
    Rider rider(points, {0.001, 0.0005, 0.03});
    // 20 mm through, and 1 mm more where the surface is at 0.
    const Ride ride = rider.to({0.001, 0.0005, -0.021});
    EXPECT_TRUE(ride.last.touching) << thickness;
    EXPECT_GE(ride.last.force.z(), 10) << thickness;
    EXPECT_LT(ride.jump, 0.2) << thickness;
    RecordProperty("surface_mm_" + std::to_string(static_cast<int>(1e3 * thickness)),
                   std::to_string(1e3 * ride.last.proxy.z()));
  }
}

// Half a plane: x <= 0.
std::vector<TestPoint> half_plane() {
  return sheet({}, {-0.06, -0.06}, {0, 0.06});
}

TEST(AcceptanceEdge, SlidingOffLetsGoOnceAndNeverPulls) {
  PointField points(half_plane());
  Rider rider(points, {-0.02, 0, 0.02});
  rider.to({-0.02, 0, -0.003});
  const Ride ride = rider.to({0.02, 0, -0.003});
  EXPECT_FALSE(ride.last.touching);
  EXPECT_LE(ride.pull, 1e-6);
  EXPECT_LE(ride.given, 1e-6);
  EXPECT_LE(ride.jump, 1.9);
  RecordProperty("drop_N", std::to_string(ride.jump));
}

TEST(AcceptanceEdge, BackSideIsTouchedAtThePointsWithoutPop) {
  PointField points(half_plane());
  Rider rider(points, {-0.02, 0.0, -0.03});
  const Ride ride = rider.to({-0.02, 0.0, 0.004});
  EXPECT_NEAR(ride.last.force.z(), -2, 0.06);
  EXPECT_LE(ride.jump, 0.06);
  EXPECT_NEAR(ride.last.proxy.z(), 0, 1e-4);
  RecordProperty("force_N", std::to_string(ride.last.force.z()));
}

TEST(AcceptanceEdge, TheWayRoundNeitherPullsNorGives) {
  PointField points(half_plane());
  Rider rider(points, {-0.02, 0, 0.02});
  double given = 0;
  for (int lap = 0; lap < 2; ++lap) {
    given = 0;
    // Over the front, off the edge, back behind, and out the way it came.
    given += rider.to({-0.02, 0, -0.003}).given;
    const Ride off = rider.to({0.02, 0, -0.003});
    EXPECT_LE(off.pull, 1e-6);
    const Ride behind = rider.to({0.02, 0, -0.02});
    EXPECT_EQ(behind.most, 0);
    given += off.given + behind.given;
    given += rider.to({-0.02, 0, -0.02}).given;
    const Ride pressed = rider.to({-0.02, 0, 0.003});
    EXPECT_NEAR(pressed.last.force.z(), -1.5, 0.05);
    given += pressed.given + rider.to({-0.02, 0, -0.02}).given;
    given += rider.to({0.03, 0, -0.02}).given + rider.to({0.03, 0, 0.02}).given;
    given += rider.to({-0.02, 0, 0.02}).given;
    EXPECT_LE(given, 1e-6);
  }
  RecordProperty("given_mJ", std::to_string(1e3 * given));
}

TEST(AcceptanceEdge, EdgeOnIsMetGently) {
  PointField points(half_plane());
  Rider rider(points, {0.03, 0, 0.0005});
  const Ride ride = rider.to({-0.03, 0, 0.0005});
  EXPECT_LE(ride.most, 0.35);
  EXPECT_LE(ride.jump_in_contact, 0.06);
  RecordProperty("most_N", std::to_string(ride.most));
}

TEST(AcceptanceFriction, IsWithinOnePercentOnPlanesOfPoints) {
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset}) {
    for (const double mu : {0.1, 0.5, 1.2}) {
      PointField points(sheet({.jitter = 0.2}, 0.06), {.kind = kind});
      Rider rider(points, {-0.03, 0, 0.02},
                  {.friction = {.static_coefficient = mu, .dynamic_coefficient = mu}});
      rider.to({-0.03, 0, -0.003});
      rider.to({-0.01, 0.002, -0.003});
      for (const double speed : {0.02, 0.2}) {
        const Contact c = rider.to({speed < 0.1 ? 0.01 : 0.03, 0.004, -0.003}, speed).last;
        const double ratio = c.force.head<2>().norm() / c.force.z();
        EXPECT_NEAR(ratio, mu, 0.01 * mu) << speed;
      }
    }
  }
}

/// Where a hand that presses down at (x, y) finds the surface, m.
double height_at(PointField& points, double x, double y) {
  Rider rider(points, {x, y, 0.05});
  return rider.to({x, y, -0.001}, 0.5).last.proxy.z();
}

double mean_height(PointField& points, double x, double spacing) {
  double sum = 0;
  constexpr int kPlaces = 4;
  for (int i = 0; i < kPlaces; ++i) {
    for (int j = 0; j < kPlaces; ++j) {
      sum += height_at(points, x + spacing * i / kPlaces, spacing * j / kPlaces);
    }
  }
  return sum / (kPlaces * kPlaces);
}

TEST(AcceptanceMetaball, OffsetIsAboutHalfARadiusWhateverM) {
  for (const double m : {2.0, 2.5, 3.0, 4.0, 5.0}) {
    const double radius = m * 4e-3;
    PointField points(sheet({.radius = radius, .jitter = 0.05}, 3 * radius),
                      {.kind = FieldOptions::Kind::metaball});
    const double offset = mean_height(points, 0, 4e-3) / radius;
    EXPECT_NEAR(offset, 0.49, 0.02) << m;
    RecordProperty("offset_R_m" + std::to_string(m).substr(0, 3), std::to_string(offset));
  }
}

TEST(AcceptanceMetaball, OffsetIgnoresTheDensity) {
  const double radius = 12e-3;
  std::vector<double> offsets;
  // Columns whose spacing grows from 3 to 6 mm along x; rows as far apart as their column's.
  std::vector<TestPoint> points;
  for (double x = -0.06, s = 3e-3; x < 0.06; x += s) {
    s = 3e-3 + 3e-3 * (x + 0.06) / 0.12;
    for (double y = -0.05; y <= 0.05; y += s)
      points.push_back({{x, y, 0}, Vector3d::UnitZ(), radius});
  }
  PointField field(points, {.kind = FieldOptions::Kind::metaball});
  double least = 1;
  double most = 0;
  for (double x = -0.035; x < 0.036; x += 0.01) {
    const double offset = mean_height(field, x, 4.5e-3);
    least = std::min(least, offset);
    most = std::max(most, offset);
  }
  RecordProperty("least_mm", std::to_string(1e3 * least));
  RecordProperty("most_mm", std::to_string(1e3 * most));
  EXPECT_LE(most - least, 0.02 * 0.5 * (most + least));
}

double bias_on_ball(FieldOptions::Kind kind, double radius) {
  const double rho = 0.06;
  PointField points(ball({.radius = radius}, rho), {.kind = kind});
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 60; ++i) {
    const double z = 1 - (2 * i + 1.0) / 60;
    const double angle = 2.4 * i;
    const double r = std::sqrt(1 - z * z);
    const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    Rider rider(points, 0.09 * direction);
    sum += rider.to(0.055 * direction, 0.5).last.proxy.norm() - rho;
    ++count;
  }
  return sum / count;
}

TEST(AcceptanceCurvature, BalancedHasNoBiasWherePointSetsSink) {
  const double balanced = bias_on_ball(FieldOptions::Kind::balanced, 16e-3);
  const double pointset = bias_on_ball(FieldOptions::Kind::pointset, 16e-3);
  RecordProperty("balanced_mm", std::to_string(1e3 * balanced));
  RecordProperty("pointset_mm", std::to_string(1e3 * pointset));
  EXPECT_LT(std::abs(balanced), 0.01e-3);
  EXPECT_NEAR(pointset, -0.497e-3, 0.02e-3);
}

}  // namespace
}  // namespace palpate::test
