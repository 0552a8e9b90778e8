// A COPC file that is opened as a store has the points of the file read whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "io/copc_bytes.hpp"
#include "io/in_cubes.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

std::string written(const test::Folder& folder, const std::string& bytes) {
  folder.write("a.copc.laz", bytes);
  return folder / "a.copc.laz";
}

/// How far a point may be off in floats around the cloud's origin, m.
double rounding(const PointCloud& cloud, std::size_t i) {
  return 2e-7 * (cloud.point(i) - cloud.origin).norm();
}

/// The nodes' points are, one after the other, those of the file; some are marked as not to be
/// used.
void expect_whole(const std::string& path, double scale) {
  ReadOptions options;
  options.scale = scale;
  const PointCloud whole = read_cloud(path, options);
  const auto store = open_store(path, {.scale = scale});
  ASSERT_TRUE(store);
  const PointStore::Layout& layout = store->layout();
  EXPECT_GE(layout.points, whole.size());
  std::size_t i = 0;
  for (std::size_t k = 0; k < layout.nodes.size(); ++k) {
    const PointCloud node = store->read(k);
    EXPECT_LE(node.size(), layout.nodes[k].points);
    EXPECT_EQ(node.origin, layout.origin);
    ASSERT_LE(i + node.size(), whole.size());
    for (std::size_t j = 0; j < node.size(); ++j, ++i) {
      ASSERT_LE((node.point(j) - whole.point(i)).norm(), rounding(node, j) + rounding(whole, i));
      if (!node.colors.empty()) {
        ASSERT_EQ(node.colors[j], whole.colors[i]);
      }
      if (!node.intensities.empty()) {
        ASSERT_EQ(node.intensities[j], whole.intensities[i]);
      }
    }
  }
  EXPECT_EQ(i, whole.size());
}

TEST(CopcStore, HasThePointsOfTheFile) {
  const test::Folder folder;
  const std::string path = written(folder, copc_bytes());
  expect_whole(path, 1);
  expect_whole(path, 0.001);
}

TEST(CopcStore, OfARealSurveyLiesInItsCubes) {
  const char* const data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA names no folder with the real data";
  const std::string path = (std::filesystem::path(data) / "pdal_small/lone-star.copc.laz").string();
  expect_whole(path, 1);
  test::expect_in_cubes(*open_store(path));
}

TEST(CopcStore, WhoseRootHasNoPointsHasColumnsAllTheSame) {
  const test::Folder folder;
  const auto swap_root = [](std::vector<CopcEntry>& entries) {
    const auto empty = std::ranges::find(entries, 0, &CopcEntry::points);
    std::swap(empty->key, entries[0].key);
  };
  const auto store = open_store(written(folder, copc_bytes(swap_root)));
  ASSERT_TRUE(store);
  int filled = 0;
  for (std::size_t k = 0; k < store->layout().nodes.size(); ++k) {
    const PointCloud node = store->read(k);
    if (node.empty()) continue;
    ++filled;
    EXPECT_EQ(node.intensities.size(), node.size());
    EXPECT_EQ(node.colors.size(), node.size());
  }
  EXPECT_GT(filled, 0);
}

TEST(CopcStore, OtherFilesAreNone) {
  const test::Folder folder;
  folder.write("a.laz", laz_of(survey_of({.format = 6})));
  EXPECT_EQ(open_store(folder / "a.laz"), nullptr);
  EXPECT_EQ(open_store(folder / "no.laz"), nullptr);
  EXPECT_EQ(open_store("synthetic:sphere"), nullptr);
}

TEST(CopcStore, SaysWhereAFileThatIsCutEnds) {
  const test::Folder folder;
  const std::string bytes = copc_bytes();
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    const std::string path = written(folder, bytes.substr(0, size));
    try {
      const auto store = open_store(path);
      EXPECT_EQ(store, nullptr) << size;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.copc.laz")) << size;
    }
  }
}

}  // namespace
}  // namespace palpate
