// The unit of a file is what it states in comments and headers, else what is likely of a mesh.
#include "io/units/file_unit.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/numbers.hpp"
#include "io/reading.hpp"
#include "io/units/length_names.hpp"
#include "support/mesh_files.hpp"

namespace palpate::io {
namespace {

using Eigen::Vector3d;
using testing::EndsWith;
using testing::HasSubstr;

struct Sentence {
  const char* text;
  double metres;
};

TEST(LengthNames, SentencesStateAUnit) {
  for (const Sentence& each : {Sentence{"# Unit: meter", 1},
                               {"# 1 unit = 1000 mm", 1},
                               {"# units: mm", 1e-3},
                               {"# File units = feet", 0.3048},
                               {"# Units in millimeters", 1e-3},
                               {"# unit=inch", 0.0254},
                               {"# 10 units = 1 cm", 1e-3},
                               {"# All coordinates in cm.", 0.01},
                               {"# UNITS: US survey feet", 1200 / 3937.0},
                               {"# 1 unit equals 0.5 yards", 0.4572},
                               {"solid part units=mm", 1e-3},
                               {"# length unit is the metre", 1},
                               {"# unit m", 1},
                               {"# Vertices are in m", 1},
                               {"# LiDAR data in US survey feet", 1200 / 3937.0},
                               {"# Units: in", 0.0254},
                               {"# This file uses centimeters as units for coordinates", 0.01},
                               {"# Units for the model vertex data itself: meters", 1},
                               {"# measured in units, where 1 unit = 1000.000000 mm", 1},
                               {"# unit = 1 in", 0.0254},
                               {"# Units: in inches", 0.0254},
                               {"comment unit um", 1e-6}}) {
    const auto metres = unit_in_sentence(each.text);
    ASSERT_TRUE(metres) << each.text;
    EXPECT_NEAR(*metres / each.metres, 1, 1e-12) << each.text;
  }
  for (const char* none :
       {"# Unit: none", "# 12 vertices", "# unit test of m", "# united in 1 m", "# Points: 200 in",
        "# made in 2 m of snow", "# Unit: ", "# units = -1 mm", "# community = 5 m",
        "# unit tests: 12 m", "# Unit 3 in block B", "# Unit 3 in 2", "# 1 unit = 1e12 km",
        "# 1 unit = 0 m", "# points in 3 ft around", "# inf units = 1 mm",
        "# 1e300 units = 1e-300 mm"}) {
    EXPECT_EQ(unit_in_sentence(none), std::nullopt) << none;
  }
}

TEST(LengthNames, NamesOfUnitsAreThoseThatPeopleWrite) {
  for (const char* foot :
       {"US survey ft", "ft", "Foot", "FEET", "foot_us", "US survey feet", "ftUS", "us-ft"}) {
    ASSERT_TRUE(metres_of(foot)) << foot;
    EXPECT_TRUE(is_same_unit(*metres_of(foot), 0.3048)) << foot;
  }
  EXPECT_EQ(metres_of("Millimeters"), 1e-3);
  EXPECT_EQ(metres_of("inches"), 0.0254);
  EXPECT_EQ(metres_of("ms"), std::nullopt) << "milliseconds";
  EXPECT_EQ(metres_of("deg"), std::nullopt);
  EXPECT_EQ(name_of_length(1200 / 3937.0), "feet");
  EXPECT_EQ(name_of_length(0.0254), "inches");
  EXPECT_EQ(name_of_length(1e-3), "millimetres");
}

std::string plate(double size, const Vector3d& at = Vector3d::Zero()) {
  return fmt::format("v {} {} {}\nv {} {} {}\nv {} {} {}\nf 1 2 3\n", at.x(), at.y(), at.z(),
                     at.x() + size, at.y(), at.z(), at.x(), at.y() + size, at.z());
}

FileUnit unit_of(const std::string& bytes, const std::string& name) {
  return read_text(bytes, name, {}).unit;
}

TEST(FileUnit, CommentsOfAMeshStateIt) {
  Random random(3);
  for (const auto& [name, metres] :
       {std::pair("meter", 1.0), std::pair("mm", 1e-3), std::pair("inches", 0.0254),
        std::pair("ft", 0.3048), std::pair("cm", 0.01)}) {
    for (const char* pattern :
         {"# Unit: {}\n", "# units = {}\n", "#1 unit = 1 {}\n", "  # File units: {}\r\n"}) {
      const double size = 0.01 + 3000 * random.uniform();
      const CloudFile file = read_text(
          "# made\n" + fmt::format(fmt::runtime(pattern), name) + plate(size), "a.obj", {});
      EXPECT_EQ(file.unit.source, FileUnit::Source::stated) << pattern << name;
      EXPECT_NEAR(file.unit.plan, metres, 1e-12);
      float longest = 0;
      for (const auto& p : file.cloud.positions) longest = std::max(longest, p.x());
      EXPECT_NEAR(static_cast<double>(longest) + file.cloud.origin.x(), size * metres,
                  0.01 * size * metres);
    }
  }
  const FileUnit by =
      unit_of("# Captured with Scaniverse (https://scaniverse.com)\n" + plate(5), "a.obj");
  EXPECT_EQ(by.plan, 1);
  EXPECT_EQ(by.source, FileUnit::Source::stated);
  std::string stl = test::as_stl(test::box_mesh(Vector3d::Constant(10)));
  EXPECT_EQ(unit_of(stl, "a.stl").source, FileUnit::Source::likely);
  stl.replace(0, 20, "UNITS=inch COLOR=....");
  EXPECT_EQ(unit_of(stl.substr(0, 20) + stl.substr(21), "a.stl").plan, 0.0254);
}

TEST(FileUnit, AMeshWithoutAUnitIsInMillimetresWhereItCouldBeAPart) {
  for (const double size : {1.0, 20.0, 1999.0}) {
    const CloudFile file = read_text(plate(size), "a.obj", {});
    EXPECT_EQ(file.unit.plan, 1e-3) << size;
    EXPECT_THAT(file.format, EndsWith(", taken as millimetres"));
  }
  for (const double size : {0.3, 2001.0}) {
    const CloudFile file = read_text(plate(size), "a.obj", {});
    EXPECT_EQ(file.unit.plan, 1) << size;
    EXPECT_EQ(file.unit.source, FileUnit::Source::likely) << "and is said to be";
    EXPECT_THAT(file.format, EndsWith(", taken as metres"));
  }
  EXPECT_EQ(unit_of(plate(20), "a.ply.obj").words.substr(0, 22), "the longest side is 20");
  EXPECT_EQ(read_text(plate(20), "a.obj", {.scale = 1}).unit.plan, 1);
  EXPECT_EQ(unit_of("v 0 0 0\nv 20 0 0\n", "a.obj").source, FileUnit::Source::assumed)
      << "points are a scan's";
}

TEST(FileUnit, AMeshInSurveyCoordinatesIsInMetres) {
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    const Vector3d at(166000 + 600000 * random.uniform(), 1e6 + 8e6 * random.uniform(), 100);
    const CloudFile file = read_text(plate(2 + 100 * random.uniform(), at), "house.obj", {});
    EXPECT_EQ(file.unit.plan, 1);
    EXPECT_THAT(file.unit.words, HasSubstr("as far from the origin as surveys"));
  }
}

TEST(FileUnit, SpacingsAreInMetresWhateverTheUnit) {
  const CloudFile file = read_text(plate(20), "a.obj", {.mesh_spacing = 0.001});
  EXPECT_NEAR(file.mesh->spacing, 0.001, 1e-12);
  EXPECT_NEAR(static_cast<double>(file.cloud.size()), 200, 40);
}

TEST(FileUnit, HeadersOfColumnsStateIt) {
  const std::string rows = "10,20,30\n40,50,60\n70,80,95\n";
  for (const char* header :
       {"X [mm],Y [mm],Z [mm]", "x(mm),y(mm),z(mm)", "X_mm,Y_mm,Z_mm", "x/mm,y/mm,z/mm",
        "\"X [mm]\",\"Y [mm]\",\"Z [mm]\"", "X,Y,Z [mm]", "# X [mm], Y [mm], Z [mm]",
        "Easting [mm],Northing [mm],Height [mm]", "# units: mm"}) {
    const CloudFile file = read_text(std::string(header) + "\n" + rows, "a.csv", {});
    EXPECT_EQ(file.unit.plan, 1e-3) << header;
    EXPECT_EQ(file.unit.height, 1e-3) << header;
    EXPECT_LT((file.cloud.point(0) - Vector3d(0.01, 0.02, 0.03)).norm(), 1e-6) << header;
  }
  for (const char* comments :
       {"# units: mm\n# made with Polycam\n", "# made with Polycam\n# units: mm\n"}) {
    EXPECT_EQ(unit_of(comments + rows, "a.csv").plan, 1e-3) << comments;
  }
  EXPECT_EQ(unit_of("# LiDAR of a wood\n" + rows, "a.csv").source, FileUnit::Source::assumed);
  const FileUnit mixed = unit_of("Easting (ft),Northing (ft),Height (m)\n" + rows, "a.csv");
  EXPECT_EQ(mixed.plan, 0.3048);
  EXPECT_EQ(mixed.height, 1);
  EXPECT_EQ(unit_of("X [in] Y [in] Z [in]\n1 2 3\n4 5 6\n", "a.txt").plan, 0.0254);
  EXPECT_EQ(unit_of("x,y,z\n" + rows, "a.csv").source, FileUnit::Source::assumed);
  EXPECT_THAT(refusal("x [m],y [mm],z [m]\n" + rows, "a.csv", {}),
              HasSubstr("x and y have two units"));
  const CloudFile degrees =
      read_text("longitude,latitude,elevation (ft)\n8,47,100\n8.001,47,200\n", "a.csv", {});
  EXPECT_EQ(degrees.unit.plan, 1);
  EXPECT_EQ(degrees.unit.height, 0.3048);
  EXPECT_FALSE(states_heights_alone(degrees.unit));
}

TEST(FileUnit, AUnitOfHeightsAloneIsThatOfAllAndIsSaidToBe) {
  const std::string rows = "10,20,30\n40,50,60\n70,80,95\n";
  for (const char* header : {"Easting, Northing, Height (ft)", "X,Y,Elevation [NAVD88 ft]",
                             "x,y,z_ft", "X,Y,Z (US survey ft)"}) {
    const FileUnit unit = unit_of(std::string(header) + "\n" + rows, "a.csv");
    EXPECT_TRUE(states_heights_alone(unit)) << header;
    EXPECT_TRUE(is_same_unit(unit.plan, 0.3048)) << header;
    EXPECT_TRUE(is_same_unit(unit.height, 0.3048)) << header;
    EXPECT_EQ(other_plan(unit), 1);
  }
  EXPECT_FALSE(states_heights_alone(unit_of("X (ft),Y,Z (ft)\n" + rows, "a.csv")));
}

TEST(FileUnit, AGivenLengthLeavesNoUnitToSay) {
  const CloudFile file = read_text("X [ft],Y [ft],Z [ft]\n1,2,3\n4,5,9\n", "a.csv", {.length = 2});
  EXPECT_EQ(file.unit.source, FileUnit::Source::given);
  EXPECT_EQ(file.format, "text, columns named");
}

}  // namespace
}  // namespace palpate::io
