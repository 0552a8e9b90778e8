// Potree stores give the points that were written, in either encoding.
#include "io/potree/potree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "io/potree_writer.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

class Potree : public testing::Test {
 protected:
  std::shared_ptr<const PointStore> open(const PotreeFiles& files, double scale = 1) const {
    files.write(folder_);
    return io::open_potree(folder_.path(), {.scale = scale});
  }

  test::Folder folder_;
};

Eigen::Vector3d place_of(const PotreePoint& p) {
  const Eigen::Vector3d number(p.number[0], p.number[1], p.number[2]);
  return 0.001 * number + Eigen::Vector3d(kPotreeOffset.data());
}

void expect_points(const PointCloud& cloud, const std::vector<PotreePoint>& points) {
  ASSERT_EQ(cloud.size(), points.size());
  ASSERT_EQ(cloud.colors.size(), points.size());
  ASSERT_EQ(cloud.intensities.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_LT((cloud.point(i) - place_of(points[i])).norm(), 1e-4) << "float holds 0.06 mm at 1 km";
    ASSERT_EQ(cloud.intensities[i], points[i].intensity);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(cloud.colors[i][k], points[i].color[k] / 257.0, 0.5);
    }
  }
}

TEST_F(Potree, GivesTheNodesAsTheyWereWritten) {
  const std::vector<PotreePoint> points = potree_hill(20'000);
  for (const bool packed : {false, true}) {
    for (const bool reversed : {false, true}) {
      const PotreeFiles files =
          potree_of(points, {.packed = packed, .levels = 2, .reversed = reversed});
      const auto store = open(files);
      const PointStore::Layout& layout = store->layout();
      EXPECT_EQ(layout.format, packed ? "Potree 2.0, BROTLI" : "Potree 2.0, DEFAULT");
      EXPECT_EQ(layout.points, points.size());
      ASSERT_EQ(layout.nodes.size(), files.nodes.size());
      for (std::size_t i = 0; i < files.nodes.size(); ++i) {
        EXPECT_EQ(layout.nodes[i].points, files.nodes[i].size());
        expect_points(store->read(i), files.nodes[i]);
      }
    }
  }
}

TEST_F(Potree, PutsEachNodeInACubeThatHoldsItsPoints) {
  const auto store = open(potree_of(potree_hill(20'000), {.levels = 2}));
  const PointStore::Layout& layout = store->layout();
  EXPECT_NEAR(layout.edge, kPotreeEdge, 1e-9);
  EXPECT_NEAR(layout.spacing, kPotreeEdge / 128, 1e-9);
  EXPECT_EQ(layout.lower, Eigen::Vector3d(kPotreeOffset.data()));
  std::set<std::pair<std::int32_t, std::array<std::int32_t, 3>>> cubes;
  std::int32_t deepest = 0;
  for (std::size_t i = 0; i < layout.nodes.size(); ++i) {
    const PointStore::Node& node = layout.nodes[i];
    EXPECT_TRUE(cubes.emplace(node.level, node.cell).second) << "two nodes are one cube";
    deepest = std::max(deepest, node.level);
    Box box = layout.box(i);
    box.lower.array() -= 1e-3;
    box.upper.array() += 1e-3;
    const PointCloud cloud = store->read(i);
    for (std::size_t k = 0; k < cloud.size(); ++k) ASSERT_TRUE(box.contains(cloud.point(k)));
  }
  EXPECT_GE(deepest, 5) << "a tree with proxies in proxies' chunks";
}

TEST_F(Potree, ScalesEverything) {
  const PotreeFiles files = potree_of(potree_hill(1000));
  const auto metres = open(files);
  const auto feet = open(files, 0.3048);
  EXPECT_EQ(feet->layout().edge, 0.3048 * metres->layout().edge);
  EXPECT_EQ(feet->layout().spacing, 0.3048 * metres->layout().spacing);
  EXPECT_EQ(feet->layout().lower, 0.3048 * metres->layout().lower);
  const PointCloud a = metres->read(0);
  const PointCloud b = feet->read(0);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((0.3048 * a.point(i) - b.point(i)).norm(), 1e-4);
  }
}

TEST_F(Potree, RefusesScalesOfNoPlace) {
  const PotreeFiles files = potree_of(potree_hill(100));
  EXPECT_THROW((void)open(files, 1e10), Error);
  EXPECT_THROW((void)open(files, 1e300), Error);
  EXPECT_THROW((void)open(files, 1e-13), Error);
  EXPECT_EQ(open(files, 1e-3)->layout().points, 100u);
}

TEST_F(Potree, ReadsCoordinatesBelowZero) {
  std::vector<PotreePoint> points = potree_hill(10);
  points[3].number = {-5, -70'000, -2'000'000'000};
  for (const bool packed : {false, true}) {
    expect_points(open(potree_of(points, {.packed = packed}))->read(0), points);
  }
}

// The largest number of all points decides, not that of a node.
TEST_F(Potree, TakesColorsOfOneKindForAllNodes) {
  std::vector<PotreePoint> points = potree_hill(200);
  for (PotreePoint& p : points) p.color = {200, 100, 50};
  const auto bytes = [&](double largest) {
    return open(potree_of(points, {.largest_color = largest}))->read(0).colors.front();
  };
  EXPECT_EQ(bytes(0), (std::array<std::uint8_t, 3>{200, 100, 50}));
  EXPECT_EQ(bytes(200), (std::array<std::uint8_t, 3>{200, 100, 50}));
  EXPECT_EQ(bytes(65280), (std::array<std::uint8_t, 3>{1, 0, 0}));
}

TEST_F(Potree, LeavesOutColumnsThatAreZeroOrAbsent) {
  std::vector<PotreePoint> points = potree_hill(200);
  for (PotreePoint& p : points) p.color = {}, p.intensity = 0;
  const auto store = open(potree_of(points));
  EXPECT_TRUE(store->read(0).colors.empty());
  EXPECT_TRUE(store->read(0).intensities.empty());
  const auto plain = open(potree_of(points, {.columns = false}));
  EXPECT_TRUE(plain->read(0).colors.empty());
  EXPECT_EQ(plain->read(0).size(), plain->layout().nodes[0].points);
}

TEST_F(Potree, DropsPointsBeyondAnyPlace) {
  PotreeFiles files = potree_of(potree_hill(100), {.in_node = 100});
  const std::string scale = "[0.001, ";
  files.metadata.replace(files.metadata.find(scale), scale.size(), "[1e7, ");
  files.write(folder_);
  const CloudFile file = read_cloud_file(folder_.path());
  EXPECT_EQ(file.declared, 100u);
  EXPECT_GT(file.dropped, 50u) << "a number times 1e7 m is below 1e12 m for a tenth of them";
  EXPECT_EQ(file.cloud.size() + file.dropped, 100u);
}

TEST_F(Potree, IsReadWholeAsAnyFile) {
  const std::vector<PotreePoint> points = potree_hill(20'000);
  for (const bool packed : {false, true}) {
    const PotreeFiles files = potree_of(points, {.packed = packed});
    files.write(folder_);
    std::vector<PotreePoint> all;
    for (const auto& node : files.nodes) all.insert(all.end(), node.begin(), node.end());
    double done = 0;
    const ReadOptions options{.progress = [&](double now) { done = now; }};
    const CloudFile file = read_cloud_file(folder_.path(), options);
    EXPECT_EQ(file.declared, points.size());
    EXPECT_EQ(file.dropped, 0u);
    EXPECT_EQ(done, 1);
    expect_points(file.cloud, all);
    EXPECT_EQ(read_cloud_file(folder_ / "metadata.json").cloud.positions, file.cloud.positions);
  }
}

TEST_F(Potree, FitsALengthAndStopsWhenAsked) {
  potree_of(potree_hill(5000)).write(folder_);
  const CloudFile file = read_cloud_file(folder_.path(), {.length = 2});
  const auto [low, high] =
      std::ranges::minmax(file.cloud.positions, {}, [](const Eigen::Vector3f& p) { return p.x(); });
  EXPECT_NEAR(high.x() - low.x(), 2, 0.05);
  const ReadOptions stopping{.progress = [](double) { throw std::runtime_error("stop"); }};
  EXPECT_THROW((void)read_cloud_file(folder_.path(), stopping), std::runtime_error);
}

TEST_F(Potree, IsRecognisedByItsMetadata) {
  EXPECT_FALSE(io::is_potree(folder_.path()));
  folder_.write("metadata.json", "{}");
  EXPECT_TRUE(io::is_potree(folder_.path()));
  EXPECT_TRUE(io::is_potree(folder_ / "metadata.json"));
  EXPECT_FALSE(io::is_potree(folder_ / "octree.bin"));
}

}  // namespace
}  // namespace palpate
