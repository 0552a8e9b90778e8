#include "session/length_unit.hpp"

#include <gtest/gtest.h>

#include "palpate/io/synthetic.hpp"

namespace palpate::session {
namespace {

Box box(const Eigen::Vector3d& lower, const Eigen::Vector3d& size) {
  Box result;
  result.extend(lower);
  result.extend(lower + size);
  return result;
}

TEST(LengthUnit, UnitsAreGuessedWithAReason) {
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

TEST(LengthUnit, AUnitThatTheFileStatesIsNotAskedFor) {
  CloudFile file;
  file.format = "LAS 1.2, point format 0, in feet";
  file.unit = {0.3048, 0.3048, FileUnit::Source::stated, true, "its GeoTIFF keys"};
  const Box survey = box({635600, 848900, 400}, {3400, 4600, 200});
  EXPECT_EQ(units_of(file, survey).units, "feet");
  EXPECT_EQ(units_of(file, survey).reason, "the file says so by its GeoTIFF keys");
  EXPECT_EQ(units_of(file, survey).advice, "");
  EXPECT_EQ(units_of(file, survey).metres, 0) << "it is used";
  file.unit.height_stated = false;
  EXPECT_NE(units_of(file, survey).advice.find("give --scale 0.3048,1"), std::string::npos);
  file.unit.height = 1;
  EXPECT_EQ(units_of(file, survey).units, "feet, heights in metres");
  file.unit = {1, 1, FileUnit::Source::given, true, "the file states feet"};
  EXPECT_NE(units_of(file, survey).advice.find("remove --scale"), std::string::npos);
}

TEST(LengthUnit, WhatWasTakenIsSaidWithWhatChangesIt) {
  CloudFile file;
  file.format = "STL, binary";
  file.unit = {0.001, 0.001, FileUnit::Source::likely, true, "a reason"};
  const Box core = box({0, 0, 0}, {0.02, 0.01, 0.01});
  EXPECT_EQ(units_of(file, core).units, "millimetres");
  EXPECT_EQ(units_of(file, core).metres, 0.001);
  EXPECT_NE(units_of(file, core).advice.find("--scale: 1 for metres"), std::string::npos);
  file.unit.plan = file.unit.height = 1;
  EXPECT_EQ(units_of(file, core).units, "metres");
  EXPECT_EQ(units_of(file, core).metres, 1);
  EXPECT_NE(units_of(file, core).advice.find("give --scale 0.001"), std::string::npos);
}

TEST(LengthUnit, OutlierSaysNothingOfTheCore) {
  PointCloud cloud = synthetic_cloud("bumps");
  const Box all = bounds_of(cloud);
  EXPECT_EQ(core_of(cloud).lower, all.lower);
  EXPECT_EQ(core_of(cloud).upper, all.upper);
  cloud.positions.push_back({500, -300, 200});
  EXPECT_GT(bounds_of(cloud).size().maxCoeff(), 400);
  EXPECT_NEAR(core_of(cloud).size().maxCoeff(), all.size().maxCoeff(), 2e-3);
}

TEST(LengthUnit, TheSettingAsksForTheLikelyUnit) {
  const Box core = box({0, 0, 0}, {0.02, 0.0105, 1.5});
  const auto setting = unit_setting("part", 0.001, UnitQuestion{core, 0.001});
  EXPECT_EQ(setting.key, "unit.part");
  EXPECT_EQ(setting.question, "part: 20 x 10.5 x 1500 mm?");
  EXPECT_EQ(unit_setting("part", 1, UnitQuestion{core, 0.3048}).question,
            "part: 0.02 x 0.0105 x 1.5 ft?")
      << "numbers as in the file, in the unit that they probably have";
  EXPECT_EQ(std::get<std::string>(setting.value), "mm");
  EXPECT_EQ(source_of_unit(setting.key), "part");
  EXPECT_EQ(source_of_unit("stiffness"), std::nullopt);
  for (const std::string& choice : setting.choices) EXPECT_TRUE(metres_of_unit(choice)) << choice;
}

TEST(LengthUnit, AnotherUnitIsNamedByItsMetresAndNotAskedFor) {
  const auto setting = unit_setting("scan", 0.002, {});
  EXPECT_EQ(std::get<std::string>(setting.value), "0.002 m");
  EXPECT_EQ(setting.choices.back(), "0.002 m");
  EXPECT_EQ(setting.question, "");
  EXPECT_EQ(metres_of_unit("0.002 m"), std::nullopt);
}

}  // namespace
}  // namespace palpate::session
