// Parts of a large cloud that are sampled far more sparsely than most of it are felt, too.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "palpate/contact/proxy.hpp"
#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/on_demand.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kFine = 1e-3;  // m: spacing of the patch
constexpr double kSide = 0.2;   // m: of the patch
constexpr int kPlaces = 100;    // that are touched
constexpr double kDeep = 5e-3;  // m

/// Adds points about `spacing` apart to the floor within `half` of the middle, but for a square.
void add_floor(double spacing, double half, double hole, PointCloud& cloud) {
  std::mt19937 random(7);
  std::normal_distribution<double> error(0, 0.1 * spacing);
  for (double x = -half; x <= half; x += spacing) {
    for (double y = -half; y <= half; y += spacing) {
      const Vector3d at(x + error(random), y + error(random), 0);
      if (at.cwiseAbs().maxCoeff() < hole) continue;
      cloud.positions.push_back(at.cast<float>());
    }
  }
}

/// A fine patch amid a floor that is sampled so many times more sparsely.
PointCloud floor_around_patch(double sparser) {
  PointCloud cloud;
  add_floor(kFine, kSide / 2, 0, cloud);
  add_floor(sparser * kFine, kSide / 2 + 20 * sparser * kFine, kSide / 2, cloud);
  return cloud;
}

/// The force on a hand that is pressed into the floor at a place, N.
double press(Scene& scene, double x, double y) {
  SceneField field(scene);
  Proxy proxy;
  proxy.reset({x, y, 0.01});
  double force = 0;
  for (int k = 0; k < 40; ++k) {
    const Vector3d hip(x, y, std::max(0.01 - 1e-3 * k, -kDeep));
    field.update(1 + 1e-3 * k, hip, proxy);
    force = proxy.step(field, hip, 1e-3).force.norm();
  }
  return force;
}

/// Are all places of the floor felt by blocks, as where the cloud is prepared together? That may
/// have a hole beside the patch.
void expect_same(double sparser) {
  const PointCloud cloud = floor_around_patch(sparser);
  SourceOptions options;
  Scene together;
  together.add("cloud", cloud, options);
  options.prepare.facts = measure_facts(cloud, {});
  Scene by_blocks;
  by_blocks.add("cloud", cloud, options);
  std::mt19937 random(8);
  const double half = kSide / 2 + 18 * sparser * kFine;
  std::uniform_real_distribution<double> place(-half, half);
  int holes = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double x = place(random);
    const double y = place(random);
    const double force = press(by_blocks, x, y);
    EXPECT_GT(force, 2) << x << ' ' << y;
    const double expected = press(together, x, y);
    if (expected > 0) {
      EXPECT_NEAR(force, expected, 0.1 * expected) << x << ' ' << y;
    } else {
      ++holes;
    }
  }
  EXPECT_LE(holes, 1);
}

TEST(SparseParts, AreFeltAsWhereAllIsPreparedTogether) {
  for (const double sparser : {3., 6., 12., 30., 100.}) {
    SCOPED_TRACE(sparser);
    expect_same(sparser);
  }
}

/// Is a place prepared as in the whole once the field says nothing is missing there?
void expect_prepared_at(const Vector3d& place, const std::shared_ptr<const PointCloud>& cloud,
                        const SourceOptions& options, Scene& whole) {
  Scene some;
  Source& source = some.add("cloud", options);
  OnDemand demand(cloud, options.prepare);
  SceneField field(some);
  double time = 1;
  while (!source.points()) demand.advance(source, time);
  do {
    demand.advance(source, time);
    for (int k = 0; k < 200; ++k) field.update_from(time += 1e-3, place, place);
  } while (has(field.notes(), FieldNote::not_loaded));
  EXPECT_GT(press(some, place.x(), place.y()), 2);
  while (!demand.done()) demand.advance(source, time);
  EXPECT_EQ(press(some, place.x(), place.y()), press(whole, place.x(), place.y()));
}

TEST(SparseParts, ArePreparedOnDemandWhereAToolComesNear) {
  constexpr double kSparser = 100;
  const auto cloud = std::make_shared<const PointCloud>(floor_around_patch(kSparser));
  SourceOptions options;
  options.prepare.facts = measure_facts(*cloud, {});
  Scene whole;
  whole.add("cloud", *cloud, options);
  for (const double beside : {0.3, 0.5, 0.8, 10.5}) {  // spacings of the floor
    SCOPED_TRACE(beside);
    expect_prepared_at({kSide / 2 + beside * kSparser * kFine, 0.1, 0}, cloud, options, whole);
  }
}

}  // namespace
}  // namespace palpate
