// Refinements come into preparation by name, at their stage, and can be left out.
#include <gtest/gtest.h>

#include <string>

#include "palpate/base/error.hpp"
#include "palpate/io/synthetic.hpp"
#include "prepare/surfels.hpp"

namespace palpate {
namespace {

Prepared prepared(const PointCloud& cloud, const PrepareOptions& options,
                  std::span<const Refinement> refinements) {
  const Placed placed = place(cloud, options, Eigen::Isometry3d::Identity());
  return prepare_at_once(placed, options, refinements, {});
}

void widen(Surfels& surfels) {
  for (float& radius : surfels.radii.values) radius *= 2;
}

void widen_again(Surfels& surfels) {
  EXPECT_FALSE(surfels.fits.normals.empty());  // the stage before is done
  for (float& radius : surfels.radii.values) radius *= 3;
}

constexpr Refinement kTwo[] = {{"widen", Stage::radii, &widen},
                               {"widen_again", Stage::fits, &widen_again}};

TEST(Refinements, RunAtTheirStages) {
  const PointCloud cloud = synthetic_cloud("sphere", {.spacing = 5e-3});
  const double radius = prepared(cloud, {}, {}).report.radius;
  EXPECT_NEAR(prepared(cloud, {}, kTwo).report.radius, 6 * radius, 1e-5 * radius);
}

TEST(Refinements, CanBeLeftOutByName) {
  const PointCloud cloud = synthetic_cloud("sphere", {.spacing = 5e-3});
  const double radius = prepared(cloud, {}, {}).report.radius;
  const auto without = [&](const std::string& name) {
    return prepared(cloud, {.without = {name}}, kTwo).report.radius;
  };
  EXPECT_NEAR(without("widen"), 3 * radius, 1e-5 * radius);
  EXPECT_NEAR(without("widen_again"), 2 * radius, 1e-5 * radius);
}

TEST(Refinements, UnknownNamesAreRefusedWithThoseThatThereAre) {
  const PointCloud cloud = synthetic_cloud("sphere", {.spacing = 5e-3});
  try {
    (void)prepared(cloud, {.without = {"shorten"}}, kTwo);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "preparation without 'shorten': there is no such refinement; give of these: "
                 "widen, widen_again");
  }
}

}  // namespace
}  // namespace palpate
