// Sources that tell of one surface at different heights, pressed and slid over.
#include <gtest/gtest.h>

#include <cmath>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/depth_frames.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::TestPoint;

constexpr double kRadius = 10e-3;  // R

// A sheet of 200 mm by 96 mm.
std::vector<TestPoint> sheet(double height, double from, double to) {
  std::vector<TestPoint> points;
  for (int i = -25; i <= 25; ++i) {
    for (int j = -12; j <= 12; ++j) {
      const Vector3d place(4e-3 * i, 4e-3 * j, height);
      if (place.x() < from || place.x() > to) continue;
      points.push_back({place, Vector3d::UnitZ(), kRadius, 1});
    }
  }
  return points;
}

struct Felt {
  double step = 0;   // the largest beyond what the spring gives for the hand's own way, N
  double force = 0;  // the largest, N
};

// Down to `height` at one end and at 0.1 m/s to the other.
Felt slide_over(SceneField& field, double height, double direction) {
  Proxy proxy;
  Felt felt;
  Vector3d hand = Vector3d::Zero();
  Vector3d force = Vector3d::Zero();
  for (int tick = 0; tick < 1400; ++tick) {
    const double z = height + 30e-3 * std::max(0.0, 1 - tick / 300.0);
    const Vector3d hip(direction * (1e-4 * std::max(0, tick - 300) - 55e-3), 0.3e-3, z);
    field.update(1e-3 * tick, hip, proxy);
    const Vector3d now = proxy.step(field, hip, 1e-3).force;
    const double way = tick == 0 ? 0 : (hip - hand).norm();
    felt.step = std::max(felt.step, (now - force).norm() - proxy.options().stiffness * way);
    felt.force = std::max(felt.force, now.norm());
    force = now;
    hand = hip;
  }
  return felt;
}

// Both everywhere; the upper one ends; the lower one ends; each ends on the other.
class DisagreeingSources : public testing::TestWithParam<double> {};

TEST_P(DisagreeingSources, AreOneSurfaceWithoutAStep) {
  constexpr double kAll = 1;  // m
  const double apart = GetParam() * kRadius;
  struct Ends {
    double lower, upper_from, upper_to;  // m
  };
  for (const Ends& ends : {Ends{kAll, -kAll, kAll}, Ends{kAll, -kAll, 0}, Ends{0, -kAll, kAll},
                           Ends{16e-3, -16e-3, kAll}}) {
    Scene scene;
    scene.add("lower").publish(test::still(sheet(0, -kAll, ends.lower)));
    scene.add("upper").publish(test::still(sheet(apart, ends.upper_from, ends.upper_to)));
    SceneField field(scene);
    for (const double depth : {1e-3, 3e-3, 4e-3}) {  // under the middle of both
      for (const double direction : {1.0, -1.0}) {
        const Felt felt = slide_over(field, 0.5 * apart - depth, direction);
        EXPECT_LT(felt.step, 0.3) << ends.lower << ' ' << ends.upper_from << ' ' << ends.upper_to
                                  << ' ' << depth;
        EXPECT_LT(felt.force, 1.35 * 500 * (0.5 * apart + depth));
        EXPECT_GT(felt.force, 0.9 * 500 * depth);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, DisagreeingSources,
                         testing::Values(0.3, 0.5, 0.7, 0.9, 1.0, 1.2, 1.5));

double radius_of(SceneField& field) {
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  return field.sample({0, 0, 1e-3}).radius;
}

TEST(Scene, WidensTheSupportsOfSourcesThatDisagreeAndOfNoOthers) {
  for (const auto& [apart, wanted] :
       {std::pair(0.3, 1.0), std::pair(0.8, 2.0), std::pair(1.4, 3.5), std::pair(1.7, 1.0)}) {
    Scene scene;
    scene.add("one").publish(test::still(test::plane(0)));
    Source& other = scene.add("other");
    SceneField field(scene);
    EXPECT_NEAR(radius_of(field), kRadius, 1e-9);
    other.publish(test::still(test::plane(-apart * kRadius)));
    EXPECT_NEAR(radius_of(field), wanted * kRadius, 1e-6) << apart;
    other.publish(test::still(test::plane(-1.03 * apart * kRadius)));
    EXPECT_NEAR(radius_of(field), wanted * kRadius, 1e-6) << "noise changes nothing";
    other.publish(nullptr);
    EXPECT_NEAR(radius_of(field), kRadius, 1e-9);
  }
}

TEST(Scene, WidensTheSupportsOfStreamsThatDisagree) {
  constexpr double kApart = 6e-3;
  Scene scene;
  for (const double height : {0.0, kApart}) {
    SourceOptions options;
    options.T_world_sensor = Eigen::Translation3d(0, 0, height) * test::looking_down();
    Source& source = scene.add(height > 0 ? "upper" : "lower", options);
    source.push(test::frame_of(test::small_camera(), 0, test::wall(0.5), 2e-4), [] { return 0.0; });
  }
  SceneField field(scene);
  EXPECT_NEAR(radius_of(field), 2.5 * kApart, 0.5e-3);
}

TEST(Scene, DoesNotWidenMetaballs) {
  Scene scene;
  scene.add("one").publish(test::still(test::plane(0)));
  scene.add("other").publish(test::still(test::plane(-8e-3)));
  SceneField field(scene, {.kind = FieldOptions::Kind::metaball});
  EXPECT_NEAR(radius_of(field), kRadius, 1e-9);
  field.change({});
  EXPECT_NEAR(radius_of(field), 20e-3, 1e-6);
}

}  // namespace
}  // namespace palpate
