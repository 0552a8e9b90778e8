// A store holds the points of its inputs, once each and where they belong, whatever happens while
// it is written.
#include "extras/tile/tile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <csignal>
#include <random>
#include <set>

#include "base/numbers.hpp"
#include "extras/tile/input.hpp"
#include "io/las_bytes.hpp"
#include "io/laz_encoder.hpp"
#include "io/laz_survey.hpp"
#include "io/store_reading.hpp"
#include "io/tile_inputs.hpp"
#include "palpate/io/files.hpp"
#include "support/effort.hpp"
#include "support/folder.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using io::tile::tile;
using io::tile::TileOptions;
using test::contents;
using test::Folder;
using test::read_store;
using test::ReadStore;
using test::Stored;
using testing::HasSubstr;

TEST(Tile, EveryPointOfALasFileIsInOneNodeAndInItsCube) {
  const Folder folder;
  std::vector<LasPoint> points = ground(20000);
  points[7].withheld = true;
  folder.write("a.las", las_bytes(2, 2, points));
  const auto result = tile({folder / "a.las"}, folder / "out", small_options());
  EXPECT_EQ(result.points, 19999U);
  EXPECT_EQ(result.dropped, 1U);
  const ReadStore store = read_store(folder / "out");
  EXPECT_EQ(store.points(), expected_of(points));
  EXPECT_GT(store.nodes.size(), 100U);
  for (const auto& [name, node] : store.nodes) {
    const std::int64_t edge = store.edge >> (name.size() - 1);
    for (const Stored& point : node.points) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_GE(point.number[k], node.lower[k]) << name;
        ASSERT_LT(point.number[k], node.lower[k] + edge) << name;
      }
    }
  }
  EXPECT_FALSE(fs::exists(folder / "out/unfinished"));
}

TEST(Tile, InnerNodesHaveOnePointInEachSmallCubeAndLeavesAreSmall) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(20000)));
  tile({folder / "a.las"}, folder / "out", small_options());
  const ReadStore store = read_store(folder / "out");
  std::size_t inner = 0;
  for (const auto& [name, node] : store.nodes) {
    if (!node.inner) {
      EXPECT_LE(node.points.size(), 200U);
      continue;
    }
    ++inner;
    const std::int64_t spacing = std::max<std::int64_t>((store.edge >> (name.size() - 1)) / 128, 1);
    std::set<std::array<std::int64_t, 3>> cubes;
    for (const Stored& point : node.points) {
      std::array<std::int64_t, 3> cube{};
      for (std::size_t k = 0; k < 3; ++k) cube[k] = point.number[k] / spacing;
      EXPECT_TRUE(cubes.insert(cube).second) << name;
    }
  }
  EXPECT_GT(inner, 20U);
}

TEST(Tile, MetadataDescribeThePoints) {
  const Folder folder;
  folder.write("a.las",
               las_bytes(2, 2,
                         {{.number = {100, 200, 300}, .intensity = 7, .color = {300, 2, 3}},
                          {.number = {200, 200, 310}, .intensity = 9, .color = {4, 5, 600}}}));
  tile({folder / "a.las"}, folder / "out");
  const nlohmann::json data = read_store(folder / "out").metadata;
  EXPECT_EQ(data["version"], "2.0");
  EXPECT_EQ(data["name"], "a");
  EXPECT_EQ(data["scale"], nlohmann::json({0.01, 0.01, 0.01}));
  EXPECT_DOUBLE_EQ(data["offset"][0].get<double>(), 637292);
  EXPECT_DOUBLE_EQ(data["boundingBox"]["max"][1].get<double>(), 851212 + 1.28);
  EXPECT_DOUBLE_EQ(data["spacing"].get<double>(), 0.01);
  const auto& attributes = data["attributes"];
  ASSERT_EQ(attributes.size(), 3U);
  EXPECT_DOUBLE_EQ(attributes[0]["max"][2].get<double>(), 514.1);
  EXPECT_EQ(attributes[1]["min"][0], 7);
  EXPECT_EQ(attributes[1]["max"][0], 9);
  EXPECT_EQ(attributes[2]["name"], "rgb");
  EXPECT_EQ(attributes[2]["max"], nlohmann::json({300, 5, 600}));
}

TEST(Tile, LazAndLasOfTheSamePointsGiveTheSameStoreWithOutliersFarAway) {
  for (const int format : {0, 3, 6, 7}) {
    const Folder folder;
    const std::string las = survey_of({.format = format, .points = 12000});
    folder.write("las/a.las", las);
    folder.write("laz/a.laz", laz_of(las, {.chunk = 700, .varying = format == 7}));
    folder.write("end/a.laz", laz_of(las, {.chunk = 5000, .place_at_end = true}));
    TileOptions options = small_options();
    tile({folder / "las/a.las"}, folder / "las/out", options);
    tile({folder / "laz/a.laz"}, folder / "laz/out", options);
    tile({folder / "end/a.laz"}, folder / "end/out", options);
    EXPECT_EQ(bytes_of(folder / "las/out"), bytes_of(folder / "laz/out")) << format;
    EXPECT_EQ(bytes_of(folder / "las/out"), bytes_of(folder / "end/out")) << format;
    EXPECT_GT(read_store(folder / "las/out").points().size(), 5000U);
  }
}

TEST(Tile, ACrowdFarFromAnOutlierIsSplitIntoChunksAllTheSame) {
  const Folder folder;
  std::vector<LasPoint> points = ground(9000);
  points.push_back({.number = {500'000'000, 0, 0}, .intensity = 1, .color = {1, 1, 1}});
  folder.write("a.las", las_bytes(2, 2, points));
  std::size_t steps = 0;
  TileOptions options = small_options();
  options.progress = [&](const std::string& step, double) {
    steps += step == "building the octree" ? 1U : 0U;
  };
  tile({folder / "a.las"}, folder / "out", options);
  EXPECT_GT(steps, 3U) << "chunks";
  EXPECT_EQ(read_store(folder / "out").points(), expected_of(points));
}

TEST(Tile, MoreTwinsThanALeafHoldsEndInOneLeafOfOneStep) {
  const Folder folder;
  std::vector<LasPoint> points(5000, {.number = {3, 4, 5}, .intensity = 2, .color = {400, 1, 1}});
  points.push_back({.number = {99, 0, 0}, .intensity = 2, .color = {400, 1, 1}});
  folder.write("a.las", las_bytes(2, 2, points));
  tile({folder / "a.las"}, folder / "out", small_options());
  EXPECT_EQ(read_store(folder / "out").points(), expected_of(points));
}

TEST(Tile, HeadersThatAnnounceWrongBoundsChangeNothing) {
  const Folder folder;
  std::string las = las_bytes(2, 2, ground(5000));
  folder.write("a.las", las);
  for (std::size_t k = 0; k < 3; ++k) {
    overwrite(las, 179 + 16 * k, 1e9);
    overwrite(las, 187 + 16 * k, -1e9);
  }
  folder.write("wrong/a.las", las);
  tile({folder / "a.las"}, folder / "out", small_options());
  tile({folder / "wrong/a.las"}, folder / "wrong/out", small_options());
  EXPECT_EQ(bytes_of(folder / "out"), bytes_of(folder / "wrong/out"));
}

TEST(Tile, OneAndManyThreadsGiveTheSameBytes) {
  const Folder folder;
  folder.write("a.laz", laz_of(las_bytes(2, 3, ground(20000)), {.chunk = 900}));
  tile({folder / "a.laz"}, folder / "many", small_options());
  const ThreadLimit one(1);
  tile({folder / "a.laz"}, folder / "one", small_options());
  EXPECT_EQ(bytes_of(folder / "many"), bytes_of(folder / "one"));
}

TEST(Tile, TheOrderOfPointsAndFilesDoesNotMatter) {
  const Folder folder;
  std::vector<LasPoint> points = ground(6000);
  folder.write("a.las", las_bytes(2, 2, points));
  std::mt19937 random(5);
  for (std::size_t i = points.size() - 1; i > 0; --i)
    std::swap(points[i], points[random() % (i + 1)]);
  const std::vector<LasPoint> first(points.begin(), points.begin() + 2500);
  const std::vector<LasPoint> second(points.begin() + 2500, points.end());
  folder.write("b/a.las", las_bytes(4, 7, first));
  folder.write("b/c.laz", laz_of(las_bytes(2, 3, second)));
  tile({folder / "a.las"}, folder / "out", small_options());
  tile({folder / "b/a.las", folder / "b/c.laz"}, folder / "b/out", small_options());
  EXPECT_EQ(bytes_of(folder / "out"), bytes_of(folder / "b/out"));
}

TEST(Tile, OtherCloudsHaveStepsThatFitTheirLength) {
  EXPECT_DOUBLE_EQ(io::tile::step_for(0), 1e-3);
  EXPECT_DOUBLE_EQ(io::tile::step_for(0.2), 1e-7);
  EXPECT_DOUBLE_EQ(io::tile::step_for(50), 1e-5);
  EXPECT_DOUBLE_EQ(io::tile::step_for(1e6), 1e-3);
  const Folder folder;
  std::string text;
  for (int i = 0; i < 900; ++i) {
    text += std::to_string(i % 30) + " " + std::to_string(i / 30) + " 0.5 " +
            std::to_string(i % 9) + " 255 0 " + std::to_string(i % 256) + "\n";
  }
  folder.write("a.xyz", text);
  TileOptions options = small_options();
  options.reading.scale = 0.001;
  tile({folder / "a.xyz"}, folder / "out", options);
  const ReadStore store = read_store(folder / "out");
  EXPECT_DOUBLE_EQ(store.metadata["scale"][0].get<double>(), 1e-8);
  EXPECT_NEAR(store.metadata["attributes"][0]["max"][0].get<double>(), 0.029, 1e-8);
  const std::vector<Stored> points = store.points();
  ASSERT_EQ(points.size(), 900U);
  EXPECT_EQ(points.back().intensity, 899 % 9) << "as the file has it";
  EXPECT_EQ(points.back().color[0], 65535);
  EXPECT_EQ(points.back().color[2], 257 * (899 % 256));
}

TEST(Tile, APointAtZeroOfASurveyInTextLeavesTheOthersWhereTheyAre) {
  EXPECT_DOUBLE_EQ(io::tile::step_for(5e6), 1e-2);
  const Folder folder;
  folder.write("a.xyz", "0 0 0\n500000 5000000 100\n500001 5000002 103\n");
  tile({folder / "a.xyz"}, folder / "out", small_options());
  const ReadStore store = read_store(folder / "out");
  EXPECT_EQ(store.points().size(), 3U);
  const nlohmann::json& most = store.metadata["attributes"][0]["max"];
  EXPECT_NEAR(most[0].get<double>(), 500001, 0.1);
  EXPECT_NEAR(most[1].get<double>(), 5000002, 0.5);  // floats from zero on
  EXPECT_NEAR(most[2].get<double>(), 103, 0.1);
}

TEST(Tile, AColumnIsKeptWhereAllInputsHaveIt) {
  const Folder folder;
  std::vector<LasPoint> bytes = ground(300);
  for (LasPoint& p : bytes) {
    for (auto& c : p.color) c &= 255;
  }
  folder.write("a.las", las_bytes(2, 2, bytes));
  folder.write("b.las", las_bytes(2, 0, ground(300, 2)));
  tile({folder / "a.las"}, folder / "a");
  tile({folder / "a.las", folder / "b.las"}, folder / "both");
  EXPECT_EQ(read_store(folder / "a").metadata["attributes"].size(), 3U);
  EXPECT_EQ(read_store(folder / "both").metadata["attributes"].size(), 2U);
  std::vector<Stored> wide = expected_of(bytes);
  for (Stored& each : wide) {
    for (auto& c : each.color) c = static_cast<std::uint16_t>(257 * c);
  }
  EXPECT_EQ(read_store(folder / "a").points(), wide) << "colours of a byte become 16 bits";
}

TEST(Tile, MadeTerrainHasAsManyPointsAsWereAskedForEachFromItsPlaceAlone) {
  const Folder folder;
  tile({"synthetic:terrain:70001"}, folder / "out", small_options());
  const ReadStore store = read_store(folder / "out");
  const std::vector<Stored> points = store.points();
  EXPECT_EQ(points.size(), 70001U);
  EXPECT_EQ(store.metadata["attributes"].size(), 1U);
  EXPECT_NEAR(store.metadata["attributes"][0]["max"][0].get<double>(), 26.5, 0.2);
  const io::tile::TileInput terrain = io::tile::make_terrain(70001);
  ASSERT_EQ(terrain.pieces, 2U);
  const auto later = terrain.read(1);
  const auto again = terrain.read(1);
  ASSERT_EQ(later.size(), 70001U - 65536U);
  for (std::size_t i = 0; i < later.size(); ++i) EXPECT_EQ(later[i].position, again[i].position);
}

TEST(Tile, WhatCannotBeTiledIsRefusedWithWords) {
  const Folder folder;
  const std::string las = las_bytes(2, 2, ground(500));
  folder.write("cut.las", las.substr(0, 5000));
  EXPECT_THAT(tile_refusal({folder / "cut.las"}, folder / "out"), HasSubstr("the file ends after"));
  const std::string laz = laz_of(las);
  folder.write("cut.laz", laz.substr(0, laz.size() / 2));
  EXPECT_THAT(tile_refusal({folder / "cut.laz"}, folder / "out"), HasSubstr("chunk table"));
  folder.write("none.las", las_bytes(2, 2, {{.number = {1, 2, 3}, .withheld = true}}));
  EXPECT_THAT(tile_refusal({folder / "none.las"}, folder / "out"),
              HasSubstr("no point that can be"));
  EXPECT_THAT(tile_refusal({"-"}, folder / "out"), HasSubstr("read more than once"));
  EXPECT_THAT(tile_refusal({"synthetic:bunny"}, folder / "out"), HasSubstr("synthetic:terrain:N"));
  EXPECT_THAT(tile_refusal({"synthetic:terrain:1e12"}, folder / "out"), HasSubstr("2.1e+09"));
  EXPECT_THAT(tile_refusal({folder / "absent.las"}, folder / "out"), HasSubstr("no such file"));
  folder.write("file", "");
  EXPECT_THAT(tile_refusal({folder / "none.las"}, folder / "file"), HasSubstr("cannot be made"));
}

}  // namespace
}  // namespace palpate
