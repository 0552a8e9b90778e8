#include "io/las_coordinates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/las_bytes.hpp"

namespace palpate {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

struct GeoKey {
  std::uint16_t id;
  std::uint16_t value;
};

// A variable length record of the projection.
std::string projection(std::uint16_t id, const std::string& body) {
  std::string record(54, '\0');
  record.replace(2, 15, "LASF_Projection");
  overwrite(record, 18, id);
  overwrite(record, 20, static_cast<std::uint16_t>(body.size()));
  return record + body;
}

std::string geo_keys(const std::vector<GeoKey>& keys) {
  std::string body(8 * (keys.size() + 1), '\0');
  for (std::size_t i = 0; i < keys.size(); ++i) {
    overwrite(body, 8 * i + 8, keys[i].id);
    overwrite(body, 8 * i + 14, keys[i].value);
  }
  return projection(34735, body);
}

std::string wkt(const std::string& text) {
  return projection(2112, text + '\0');
}

// A LAS file with this record.
std::string las_with(const std::string& record) {
  std::string bytes = las_bytes(2, 0, las_points());
  bytes.insert(227, record);
  overwrite(bytes, 96, static_cast<std::uint32_t>(230 + record.size()));
  overwrite<std::uint32_t>(bytes, 100, 1);
  return bytes;
}

std::string format_with(const std::string& record) {
  return read_text(las_with(record), "a.las", {}).format;
}

constexpr const char* kProjected =
    R"(PROJCS["a",GEOGCS["b",UNIT["degree",0.0174532925]],UNIT["foot",0.3048,AUTHORITY["EPSG","9002"]]])";

TEST(LasCoordinates, RefuseDegrees) {
  for (const std::string& record :
       {geo_keys({{1024, 2}, {2048, 4326}}), wkt(R"(GEOGCS["WGS 84",UNIT["degree",0.0174532925]])"),
        wkt(R"(GEOGCRS["WGS 84"])"), wkt(R"(COMPD_CS["a",GEOGCS["b"],VERT_CS["c"]])")}) {
    try {
      (void)format_with(record);
      FAIL() << record;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("degrees"));
      EXPECT_THAT(error.what(), HasSubstr("filters.reprojection"));
    }
  }
}

TEST(LasCoordinates, TellTheUnitThatTheFileStates) {
  const std::string without = format_with(geo_keys({{1024, 1}}));
  EXPECT_EQ(format_with(geo_keys({{1024, 1}, {3076, 9001}})), without + ", in metres");
  for (const std::uint16_t foot : {9002, 9003}) {
    EXPECT_EQ(format_with(geo_keys({{1024, 1}, {3076, foot}})), without + ", in feet");
  }
  EXPECT_EQ(format_with(geo_keys({{3076, 9096}})), without + ", in yards");
  EXPECT_EQ(format_with(geo_keys({{3076, 9001}, {4099, 9003}})),
            without + ", in metres, heights in feet");
  EXPECT_EQ(format_with(geo_keys({{3072, 2225}})), without + ", in feet") << "by the system's code";
  EXPECT_EQ(format_with(geo_keys({{3072, 26910}, {4096, 6360}})),
            without + ", in metres, heights in feet");
  EXPECT_EQ(format_with(geo_keys({{3072, 32767}})), without) << "a user's own";
  EXPECT_EQ(format_with(wkt(kProjected)), without + ", in feet");
  EXPECT_EQ(format_with(wkt(R"(PROJCS["a",UNIT["US survey foot",0.3048006096012192]])")),
            without + ", in feet");
  EXPECT_EQ(format_with(wkt(R"(COMPD_CS["a",PROJCS["a",UNIT["metre",1]],)"
                            R"(VERT_CS["b",UNIT["foot",0.3048]]])")),
            without + ", in metres, heights in feet");
  EXPECT_EQ(
      format_with(wkt(R"(PROJCS["a",UNIT["Foot_US",0.3048006096]],VERTCS["b",UNIT["Meter",1]])")),
      without + ", in feet, heights in metres")
      << "in a row, as ESRI writes them";
  for (const char* broken : {"PROJCS[UNIT[", "PROJCS[UNIT[\"m\",", "UNIT[\"m\",x]", ""}) {
    EXPECT_EQ(format_with(wkt(broken)), without) << broken;
  }
}

TEST(LasCoordinates, HeightsHaveAUnitOfTheirOwn) {
  const std::string bytes = las_with(geo_keys({{3076, 9001}, {4099, 9002}}));
  const PointCloud plain = read_text(bytes, "a.las").cloud;
  const CloudFile stated = read_text(bytes, "a.las", {});
  EXPECT_EQ(stated.unit.plan, 1);
  EXPECT_EQ(stated.unit.height, 0.3048);
  const Eigen::Vector3d factors(1, 1, 0.3048);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_LT((stated.cloud.point(i) - plain.point(i).cwiseProduct(factors)).norm(), 1e-3);
  }
  const CloudFile given = read_text(bytes, "a.las", {.scale = 0.5, .height_scale = 2});
  EXPECT_LT(
      (given.cloud.point(1) - plain.point(1).cwiseProduct(Eigen::Vector3d(0.5, 0.5, 2))).norm(),
      5e-3);
  EXPECT_THAT(given.unit.words, HasSubstr("heights in feet"));
  EXPECT_THAT(refusal(bytes, "a.las", {.height_scale = 2}), HasSubstr("heights alone"));
}

TEST(LasCoordinates, SaysThatOnlyHeightsHaveAUnit) {
  const CloudFile file = read_text(las_with(geo_keys({{4099, 9002}})), "a.las", {});
  EXPECT_EQ(file.unit.plan, 1);
  EXPECT_EQ(file.unit.height, 0.3048);
  EXPECT_THAT(file.unit.words, HasSubstr("its GeoTIFF keys for heights alone"));
}

TEST(LasCoordinates, AUnitThatIsNoneIsRefusedUnlessOneIsGiven) {
  const std::string bytes = las_with(wkt(R"(PROJCS["a",UNIT["foot",0]])"));
  EXPECT_THAT(refusal(bytes, "a.las", {}), HasSubstr("a unit of 0 m, which is none"));
  EXPECT_EQ(read_text(bytes, "a.las", {.scale = 1}).cloud.size(), 2u);
}

TEST(LasCoordinates, ReadKeysThatAreCutOff) {
  std::string record = geo_keys({{3076, 9001}});
  record.resize(record.size() - 1);
  overwrite(record, 20, static_cast<std::uint16_t>(15));
  EXPECT_THAT(format_with(record), EndsWith("point format 0"));
}

TEST(LasCount, TellsOfPointsBehindAsManyAsAreDeclared) {
  std::string bytes = las_bytes(2, 0, las_points());
  overwrite<std::uint32_t>(bytes, 107, 2);
  const CloudFile file = read_text(bytes, "a.las");
  EXPECT_EQ(file.cloud.size(), 2U);
  EXPECT_THAT(file.format, EndsWith(", 1 more than its header declares, which are not used"));
  EXPECT_THAT(read_text(bytes + "other data", "a.las").format, EndsWith("format 0"));
  std::string records = las_bytes(4, 0, las_points());
  overwrite<std::uint64_t>(records, 247, 2);
  EXPECT_THAT(read_text(records, "a.las").format, HasSubstr("1 more than its header declares"));
  overwrite<std::uint32_t>(records, 243, 1);
  EXPECT_THAT(read_text(records, "a.las").format, EndsWith("format 0")) << "records follow";
  overwrite<std::uint32_t>(bytes, 107, 0);
  EXPECT_THAT(refusal(bytes, "a.las"), HasSubstr("declares no points, but 3 are there"));
  EXPECT_THAT(refusal(bytes.substr(0, 230), "a.las"), HasSubstr("holds no points"));
}

}  // namespace
}  // namespace palpate
