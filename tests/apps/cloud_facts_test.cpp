#include "apps/palpate/sources/cloud_facts.hpp"

#include <gtest/gtest.h>

#include "palpate/io/synthetic.hpp"

namespace palpate::app {
namespace {

Box box(const Eigen::Vector3d& lower, const Eigen::Vector3d& size) {
  Box result;
  result.extend(lower);
  result.extend(lower + size);
  return result;
}

TEST(CloudFacts, UnitsAreGuessedWithAReason) {
  EXPECT_EQ(guess_units(box({0, 0, 0}, {0.15, 0.15, 0.12}), "PLY").units, "metres");
  EXPECT_EQ(guess_units(box({0, 0, 0}, {5200, 7660, 1900}), "PCD").units, "millimetres");
  EXPECT_EQ(guess_units(box({0, 0, 0}, {120, 80, 60}), "PLY").units, "metres or millimetres");
  const UnitsGuess feet = guess_units(box({635600, 848900, 400}, {3400, 4600, 200}), "LAS 1.2");
  EXPECT_EQ(feet.units, "metres or feet");
  EXPECT_NE(feet.advice.find("0.3048"), std::string::npos);
  EXPECT_EQ(guess_units(box({515380, 4918340, 2300}, {40, 40, 20}), "LAS 1.4").units, "metres");
  EXPECT_EQ(guess_units(box({0, 0, 0}, {500, 1, 1}), "glTF, binary").units, "metres");
  EXPECT_EQ(guess_units(box({1, 2, 3}, {0, 0, 0}), "XYZ").units, "unknown");
  const UnitsGuess far = guess_units(box({1e12, 0, 0}, {0, 0.4, 0}), "XYZ");
  EXPECT_NE(far.reason.find("beyond 1e+09 m"), std::string::npos) << far.reason;
}

TEST(CloudFacts, AUnitThatTheFileStatesIsNotAskedFor) {
  CloudFile file;
  file.format = "LAS 1.2, point format 0, in feet";
  const Box survey = box({635600, 848900, 400}, {3400, 4600, 200});
  EXPECT_EQ(units_of(file, survey, {}).units, "feet");
  EXPECT_NE(units_of(file, survey, {}).advice, "");
  EXPECT_EQ(units_of(file, survey, {.scale = 0.3048}).advice, "");
  file.format = "LAS 1.2, point format 0, in metres";
  EXPECT_EQ(units_of(file, survey, {}).advice, "");
}

TEST(CloudFacts, AMeshWithoutAUnitIsInMillimetresWhereAPartOfAMachineCouldBe) {
  const auto unit = [](const char* format, float longest, bool faces = true) {
    CloudFile file;
    if (faces) file.mesh.emplace();
    file.format = format;
    file.cloud.positions = {{0, 0, 0}, {longest, 0, 0}, {0, longest / 2, 0}};
    return likely_unit(file);
  };
  EXPECT_EQ(unit("STL, binary", 20), 0.001);
  EXPECT_EQ(unit("OBJ", 1), 0.001);
  EXPECT_EQ(unit("STL, ascii", 2000), 0.001);
  EXPECT_EQ(unit("STL, binary", 0.9f), 1);
  EXPECT_EQ(unit("OBJ", 2001), 1);
  EXPECT_EQ(unit("OBJ", 5, false), 1) << "points of a scan";
  EXPECT_EQ(unit("PLY, ascii", 20), 1);
  EXPECT_EQ(unit("glTF, binary", 20), 1);
}

TEST(CloudFacts, PlacesAndLinesHaveNoSurface) {
  const Eigen::Vector3f a(0.5f, 0.1f, -3.f);
  const Eigen::Vector3f way(0.3f, 0.1f, 0.2f);
  EXPECT_TRUE(on_a_line({}));
  EXPECT_TRUE(on_a_line(std::vector{a, a, a}));
  EXPECT_TRUE(on_a_line(std::vector{a, Eigen::Vector3f(a + way), a, Eigen::Vector3f(a + 7 * way)}));
  EXPECT_FALSE(on_a_line(std::vector{a, Eigen::Vector3f(a + way), Eigen::Vector3f(way)}));
}

TEST(CloudFacts, SpacingIsTheSquareGridsOwn) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 10000; ++i) {
    points.emplace_back(0.01f * static_cast<float>(i % 100), 0.01f * static_cast<float>(i / 100),
                        0.f);
  }
  const SpacingFacts facts = measure_spacing(CellGrid(points));
  EXPECT_NEAR(facts.nearest_three, 0.01, 1e-5);
  EXPECT_NEAR(facts.from_area, 0.01, 1e-5);
  EXPECT_NEAR(facts.tenth, 0.01, 1e-5);
}

TEST(CloudFacts, ClosedSurfaceHasNoRimAndASheetHasOne) {
  EXPECT_LT(rim_share(prepare(synthetic_cloud("sphere")).points), 0.002);
  const double sheet = rim_share(prepare(synthetic_cloud("sheet")).points);
  EXPECT_GT(sheet, 0.01);
  EXPECT_LT(sheet, 0.12);
}

TEST(CloudFacts, OnePointIsAllRim) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}};
  EXPECT_EQ(measure_spacing(CellGrid(cloud.positions)).from_area, 0);
  EXPECT_EQ(rim_share(prepare(cloud).points), 1);
}

TEST(CloudFacts, OutlierSaysNothingOfTheCore) {
  PointCloud cloud = synthetic_cloud("bumps");
  const Box all = bounds_of(cloud);
  EXPECT_EQ(core_of(cloud).lower, all.lower);
  EXPECT_EQ(core_of(cloud).upper, all.upper);
  cloud.positions.push_back({500, -300, 200});
  EXPECT_GT(bounds_of(cloud).size().maxCoeff(), 400);
  EXPECT_NEAR(core_of(cloud).size().maxCoeff(), all.size().maxCoeff(), 2e-3);
}

}  // namespace
}  // namespace palpate::app
