// Units are read from well-known text of every dialect, apart for plan and height.
#include "io/units/wkt.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/numbers.hpp"
#include "io/input.hpp"
#include "io/units/epsg.hpp"
#include "io/units/file_unit.hpp"
#include "io/units/length_names.hpp"
#include "io/units/stated_units.hpp"
#include "palpate/base/error.hpp"
#include "support/effort.hpp"

namespace palpate::io {
namespace {

constexpr const char* kGeographic =
    R"(GEOGCS["b",DATUM["c",SPHEROID["d",6378137,298.25]],UNIT["degree",0.0174532925]])";

struct NamedUnit {
  const char* name;
  double metres;
  int code;
};

constexpr NamedUnit kUnits[] = {{"metre", 1, 9001},
                                {"foot", 0.3048, 9002},
                                {"US survey foot", 0.304800609601219, 9003},
                                {"millimetre", 0.001, 1025},
                                {"yard", 0.9144, 9096},
                                {"Kilometer", 1000, 9036}};

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t count) {
    return std::min(static_cast<std::size_t>(random_.uniform() * static_cast<double>(count)),
                    count - 1);
  }

  // The factor, the code or the name tells it.
  std::string unit(const NamedUnit& unit, const char* keyword) {
    switch (below(3)) {
      case 0:
        return fmt::format(R"({}["{}",{}])", keyword, unit.name, unit.metres);
      case 1:
        return fmt::format(R"({}["?",ID["EPSG",{}]])", keyword, unit.code);
      default:
        return fmt::format(R"({}["{}"])", keyword, unit.name);
    }
  }

  std::string plan(const NamedUnit& named) {
    if (below(2) == 0) {
      return fmt::format(R"(PROJCS["a",{},PROJECTION["p"],{},AXIS["X",EAST]])", kGeographic,
                         unit(named, "UNIT"));
    }
    const std::string length = unit(named, "LENGTHUNIT");
    const std::string base =
        R"(PROJCRS["a",BASEGEOGCRS["b",DATUM["c",ELLIPSOID["d",6378137,298,LENGTHUNIT["metre",1]]]],)"
        R"(CONVERSION["e",METHOD["f"],PARAMETER["g",1,LENGTHUNIT["metre",1]]],CS[Cartesian,2],)";
    if (below(2) == 0) return base + R"(AXIS["E",east],AXIS["N",north],)" + length + "]";
    return base + fmt::format(R"(AXIS["E",east,{0}],AXIS["N",north,{0}]])", length);
  }

  std::string height(const NamedUnit& named) {
    if (below(2) == 0)
      return fmt::format(R"(VERT_CS["h",VERT_DATUM["i",2005],{}])", unit(named, "UNIT"));
    return fmt::format(R"(VERTCRS["h",VDATUM["i"],CS[vertical,1],AXIS["up",up,{}]])",
                       unit(named, "LENGTHUNIT"));
  }

  // Small letters, blanks, round brackets, a bound system.
  std::string dressed(std::string text) {
    if (below(3) == 0) {
      text = fmt::format("BOUNDCRS[SOURCECRS[{}],TARGETCRS[{}],ABRIDGEDTRANSFORMATION[\"t\"]]",
                         text, kGeographic);
    }
    if (below(3) == 0) text = lower_case(text);
    if (below(3) == 0) {
      std::ranges::replace(text, '[', '(');
      std::ranges::replace(text, ']', ')');
    }
    if (below(3) == 0) {
      std::string spaced;
      for (const char c : text) spaced += c == ',' ? std::string(",\n   ") : std::string(1, c);
      text = spaced;
    }
    return text;
  }

 private:
  Random random_;
};

TEST(Wkt, UnitsOfPlanAndHeightAreReadInEveryDialect) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Writer writer(seed);
    const NamedUnit& plan = kUnits[writer.below(std::size(kUnits))];
    const NamedUnit& height = kUnits[writer.below(std::size(kUnits))];
    const bool both = writer.below(3) > 0;
    std::string text = writer.plan(plan);
    if (both) {
      text = fmt::format(R"({}["k",{},{}])", writer.below(2) == 0 ? "COMPD_CS" : "COMPOUNDCRS",
                         text, writer.height(height));
    }
    text = writer.dressed(text);
    const StatedUnits stated = units_in_projection(text);
    EXPECT_FALSE(stated.degrees) << text;
    ASSERT_TRUE(stated.plan) << text;
    EXPECT_TRUE(is_same_unit(*stated.plan, plan.metres)) << text;
    ASSERT_EQ(stated.height.has_value(), both) << text;
    if (both) {
      EXPECT_TRUE(is_same_unit(*stated.height, height.metres)) << text;
    }
  }
}

TEST(Wkt, DegreesAreFoundInEveryDialect) {
  const std::string geodetic =
      R"(GEODCRS["a",DATUM["b",ELLIPSOID["c",6378137,298,LENGTHUNIT["metre",1]]],CS[ellipsoidal,2],)"
      R"(AXIS["latitude",north,ANGLEUNIT["degree",0.01745]],ID["EPSG",4326]])";
  const std::string plain = kGeographic;
  for (const std::string& text : {geodetic, lower_case(geodetic), plain,
                                  "BOUNDCRS[SOURCECRS[" + geodetic + "],TARGETCRS[a[1]]]",
                                  "COMPD_CS[\"a\"," + plain + ",VERT_CS[\"b\",UNIT[\"metre\",1]]]",
                                  std::string("+proj=longlat +datum=WGS84")}) {
    EXPECT_TRUE(units_in_projection(text).degrees) << text;
  }
  const StatedUnits geocentric = units_in_projection(
      R"(GEODCRS["a",DATUM["b"],CS[Cartesian,3],AXIS["X",geocentricX],LENGTHUNIT["metre",1]])");
  EXPECT_FALSE(geocentric.degrees);
  EXPECT_EQ(geocentric.plan, 1);
}

TEST(Wkt, AThreeDimensionalSystemStatesHeights) {
  const StatedUnits stated = units_in_projection(
      R"(PROJCRS["a",BASEGEOGCRS["b"],CS[Cartesian,3],AXIS["E",east,LENGTHUNIT["foot",0.3048]],)"
      R"(AXIS["N",north,LENGTHUNIT["foot",0.3048]],AXIS["h",up,LENGTHUNIT["metre",1]]])");
  EXPECT_EQ(stated.plan, 0.3048);
  EXPECT_EQ(stated.height, 1);
}

TEST(Wkt, ACodeAloneStatesTheUnitOfItsSystem) {
  EXPECT_EQ(units_in_projection(R"(PROJCRS["a",ID["EPSG",2225]])").plan, 0.3048);
  EXPECT_EQ(units_in_projection(R"(PROJCS["a",AUTHORITY["EPSG","26910"]])").plan, 1);
  EXPECT_EQ(units_in_projection("EPSG:2263").plan, 0.3048);
  for (const char* text : {"epsg:2263", "urn:ogc:def:crs:EPSG::2263",
                           "URN:OGC:DEF:CRS:EPSG:9.8:2263", "EPSG:2263+5703"}) {
    EXPECT_EQ(units_in_projection(text).plan, 0.3048) << text;
  }
  EXPECT_EQ(units_in_projection("EPSG:26910+6360").height, 0.3048);
  EXPECT_EQ(units_in_projection("+proj=lcc +units=us-ft +vunits=m").height, 1);
  EXPECT_EQ(units_in_projection("+proj=lcc +to_meter=0.9144").plan, 0.9144);
  EXPECT_EQ(metres_of_epsg_system(6360), 0.3048);
  EXPECT_EQ(metres_of_epsg_system(5703), 1);
  EXPECT_EQ(metres_of_epsg_system(32767), std::nullopt);
  EXPECT_EQ(metres_of_epsg_unit(9003), 1200 / 3937.0);
}

TEST(Wkt, CodesOfGeographicSystemsAreDegreesWhereverTheyAre) {
  for (const unsigned code :
       {3819U, 4258U, 4269U, 4326U, 4979U, 5132U, 6318U, 6706U, 7844U, 9057U}) {
    EXPECT_TRUE(is_epsg_system_in_degrees(code)) << code;
    EXPECT_EQ(metres_of_epsg_system(code), std::nullopt) << code;
    EXPECT_TRUE(units_in_projection(fmt::format("EPSG:{}", code)).degrees) << code;
  }
  for (const unsigned code : {3857U, 4087U, 4647U, 4978U, 5514U, 6677U, 7856U, 26910U, 32633U}) {
    EXPECT_FALSE(is_epsg_system_in_degrees(code)) << code;
    EXPECT_EQ(metres_of_epsg_system(code), 1) << code;
  }
}

TEST(Wkt, AFactorThatIsNoUnitIsRefusedByName) {
  const ReadOptions options;
  const auto refusal_of = [&](const char* factor) {
    const std::string text = fmt::format(R"(PROJCS["a",UNIT["foot",{}]])", factor);
    try {
      (void)in_stated_unit({{}, "a.las", options}, units_in_projection(text), "its text");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* factor : {"0", "-1", "nan", "inf", "1e-10", "2e9", "1e300"}) {
    EXPECT_NE(refusal_of(factor).find("a.las: it states by its text a unit of"), std::string::npos)
        << factor;
  }
  for (const char* factor : {"1e-9", "0.3048", "1e9"}) EXPECT_EQ(refusal_of(factor), "") << factor;
  const ReadOptions given{.scale = 1};
  EXPECT_EQ(in_stated_unit({{}, "a", given}, {.plan = 0}, "its text").unit.plan, 1) << "the remedy";
}

TEST(Wkt, WhatIsCutOrDamagedIsNoTree) {
  Writer writer(7);
  const std::string text =
      fmt::format("COMPD_CS[\"a\",{},{}]", writer.plan(kUnits[1]), writer.height(kUnits[0]));
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_FALSE(parse_wkt(text.substr(0, size))) << size;
  }
  EXPECT_FALSE(parse_wkt(std::string(5000, '[')));
  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "A[";
  EXPECT_FALSE(parse_wkt(deep));
  EXPECT_FALSE(parse_wkt(text + "x"));
  EXPECT_TRUE(parse_wkt(text + std::string(3, '\0')));
  for (int i = 0; i < test::effort(2000); ++i) {
    std::string flipped = text;
    flipped[writer.below(text.size())] = static_cast<char>(writer.below(256));
    const ReadOptions options;
    try {
      const FileUnit unit =
          in_stated_unit({{}, "flipped", options}, units_in_projection(flipped), "text").unit;
      ASSERT_TRUE(is_unit_of_length(unit.plan) && is_unit_of_length(unit.height)) << flipped;
    } catch (const Error& error) {
      ASSERT_NE(std::string(error.what()).find("which is none"), std::string::npos) << flipped;
    }
  }
}

}  // namespace
}  // namespace palpate::io
