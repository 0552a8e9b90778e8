// Parts of a cloud become what they are in the whole, where the facts of the whole are given.

#include "large/blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// 62 500 points over the unit square, z = height(x, y), off their places by half a spacing.
template <class Height>
PointCloud field(const Height& height, double noise = 0) {
  std::mt19937 random(5);
  std::normal_distribution<double> error(0, 1);
  PointCloud cloud;
  cloud.origin = {700, -300, 20};
  for (int i = 0; i < 250; ++i) {
    for (int j = 0; j < 250; ++j) {
      const double x = (i + 0.2 * error(random)) / 250;
      const double y = (j + 0.2 * error(random)) / 250;
      const double z = height(x, y) + noise * error(random);
      cloud.positions.push_back(Vector3d(x, y, z).cast<float>());
    }
  }
  return cloud;
}

/// Steps, two layers, hills, outliers above them, and noise that is thinned.
std::vector<PointCloud> made_clouds() {
  const auto hills = [](double x, double y) { return 0.05 * std::sin(9 * x) * std::cos(7 * y); };
  std::vector<PointCloud> clouds;
  clouds.push_back(field(hills));
  clouds.push_back(field([](double x, double) { return 0.03 * std::floor(8 * x); }));
  clouds.push_back(field([](double x, double y) { return std::fmod(41 * x + y, 0.02); }));
  clouds.push_back(field(hills));
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(0, 1);
  for (int i = 0; i < 800; ++i) {
    clouds.back().positions.emplace_back(place(random), place(random), 0.5f * place(random));
  }
  clouds.push_back(field(hills, 0.0015));
  return clouds;
}

struct PlaceOrder {
  bool operator()(const Vector3f& a, const Vector3f& b) const {
    return std::array{a.x(), a.y(), a.z()} < std::array{b.x(), b.y(), b.z()};
  }
};
using Places = std::multimap<Vector3f, std::uint32_t, PlaceOrder>;

/// Are all columns of the points equal, but for the numbers of segments?
bool same_columns(const SurfacePoints& a, std::uint32_t i, const SurfacePoints& b,
                  std::uint32_t k) {
  return a.normals[i] == b.normals[k] && a.density_weights[i] == b.density_weights[k] &&
         a.radii[i] == b.radii[k] && a.confidences[i] == b.confidences[k] &&
         a.segments.residual[i] == b.segments.residual[k];
}

/// The tight box of all points, m.
Box bounds_of(const PointCloud& cloud) {
  Box box;
  for (std::size_t i = 0; i < cloud.size(); ++i) box.extend(cloud.point(i));
  return box;
}

/// Less up to a third of the box at one end of each horizontal axis.
Box draw_crop(const Box& all, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  Box crop = all;
  for (int axis = 0; axis < 2; ++axis) {
    const double cut = all.size()[axis] / 3 * share(random);
    share(random) < 0.5 ? crop.lower[axis] += cut : crop.upper[axis] -= cut;
  }
  return crop;
}

/// The blocks of which the crop has all points of the whole, and all that tell what they become. On
/// a level beyond the first the whole cube tells: a crop may make more points in it sparse.
std::vector<std::size_t> whole_blocks(const Division& division, double typical, const Box& all,
                                      const Box& crop) {
  constexpr double kKnown = 16;  // R: a halo of 12, and whether the cells in it are settled
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < division.size(); ++k) {
    const Box& block = division.box(k);
    const double radius = division.radius(k);
    const double around = (radius > typical ? kKnown + Division::kBlockEdge : kKnown) * radius;
    const Vector3d lower = (block.lower.array() - around).max(all.lower.array());
    const Vector3d upper = (block.upper.array() + around).min(all.upper.array());
    if (crop.contains(lower) && crop.contains(upper)) found.push_back(k);
  }
  return found;
}

/// Compares crops with the whole in all blocks that they hold with their halos; how many points.
std::size_t compare_crops(const PointCloud& cloud, int crops, unsigned seed) {
  PrepareOptions options;
  options.facts = measure_facts(cloud, options);
  // Blocks of a third of the cloud at most: what is equal must be so for any.
  const double third = options.facts->extent.size().head<2>().minCoeff() / 3;
  options.facts->radius = std::min(options.facts->radius / 3, third / 96);
  const Division division(cloud, *options.facts);
  const SurfacePoints whole = prepare(cloud, options).points;
  Places places;
  for (std::uint32_t i = 0; i < whole.size(); ++i) places.emplace(whole.grid.points()[i], i);
  std::mt19937 random(seed);
  const Box all = bounds_of(cloud);
  std::size_t compared = 0;
  for (int k = 0; k < crops; ++k) {
    const Box crop = draw_crop(all, random);
    const SurfacePoints part = prepare(clip(cloud, crop), options).points;
    const std::vector<std::size_t> known = whole_blocks(division, options.facts->radius, all, crop);
    for (std::uint32_t i = 0; i < part.size(); ++i) {
      const Vector3d at = part.origin + part.grid.points()[i].cast<double>();
      const auto is_inside = [&](std::size_t block) { return division.owns(block, at); };
      if (std::ranges::none_of(known, is_inside)) continue;
      const auto [begin, end] = places.equal_range(part.grid.points()[i]);
      const auto is_same = [&](const auto& p) { return same_columns(part, i, whole, p.second); };
      if (std::none_of(begin, end, is_same)) {
        ADD_FAILURE() << "crop " << k << ", point " << at.transpose();
        return compared;
      }
      ++compared;
    }
  }
  return compared;
}

TEST(Blocks, PartsAreAsInTheWhole) {
  unsigned seed = 1;
  for (const PointCloud& cloud : made_clouds()) {
    EXPECT_GT(compare_crops(cloud, 4, seed++), 20'000u);
  }
}

TEST(Blocks, PartsOfRealCloudsAreAsInTheWhole) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  unsigned seed = 1;
  for (const char* name : {"stanford_bunny/bun_zipper.ply", "pdal_small/autzen_trim.las",
                           "redwood_open3d_mit/fragment.pcd", "pcl_tabletop/room_scan1.pcd",
                           "pcl_tabletop/milk_cartoon_all_small_clorox.pcd"}) {
    const auto path = std::filesystem::path(data) / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    EXPECT_GT(compare_crops(read_cloud(path.string()), 4, seed++), 0u) << name;
  }
}

TEST(Blocks, AnyOrderGivesTheSame) {
  const PointCloud cloud = made_clouds()[1];
  const Placed placed{cloud, {}, {}};
  PrepareOptions options;
  options.facts = measure_facts(cloud, {});
  options.facts->radius /= 3;
  const Blocks blocks(placed, options);
  ASSERT_GT(blocks.size(), 2u);
  const std::vector<Piece> pieces = blocks.prepare_all();
  std::vector<const Piece*> some;
  for (const Piece& piece : pieces) some.push_back(&piece);
  const auto joined = [&] { return join(some, blocks.facts(), cloud.origin, options.kernel); };
  const Prepared all = joined();
  const Prepared again = prepare(cloud, options);
  EXPECT_TRUE(std::ranges::equal(all.points.grid.points(), again.points.grid.points()));
  EXPECT_EQ(all.points.normals, again.points.normals);
  EXPECT_EQ(all.report.points_in, cloud.size());
  some.resize(1);
  const SurfacePoints one = joined().points;
  std::size_t at = 0;  // its points come in the order that they have among all
  for (std::uint32_t i = 0; i < all.points.size() && at < one.size(); ++i) {
    if (all.points.grid.points()[i] == one.grid.points()[at]) ++at;
  }
  EXPECT_EQ(at, one.size());
}

TEST(Blocks, GivenNormalsSayWhereOutwardIsBesideAViewpointOfTheFile) {
  PointCloud cloud = made_clouds()[0];
  cloud.normals.assign(cloud.size(), -Vector3f::UnitZ());
  cloud.viewpoint = Vector3d(0.5, 0.5, 2);  // on the other side
  PrepareOptions options;
  const auto point_down = [&] {
    const SurfacePoints points = prepare(cloud, options).points;
    return std::ranges::all_of(points.normals, [](const Vector3f& n) { return n.z() < 0; });
  };
  EXPECT_TRUE(point_down());
  options.facts = measure_facts(cloud, {});
  EXPECT_TRUE(point_down());
  options.viewpoint = cloud.viewpoint;  // one that is asked for is believed
  EXPECT_FALSE(point_down());
}

TEST(Blocks, PointsThatAClipLeavesOutWereRead) {
  const PointCloud cloud = made_clouds()[0];
  PrepareOptions options;
  options.clip = bounds_of(cloud);
  options.clip->upper.x() = options.clip->center().x();
  const Prepared::Report at_once = prepare(cloud, options).report;
  options.facts = measure_facts(cloud, options);
  const Prepared::Report by_blocks = prepare(cloud, options).report;
  EXPECT_EQ(by_blocks.points_in, at_once.points_in);
  EXPECT_EQ(by_blocks.points_out, at_once.points_out);
  EXPECT_GT(by_blocks.seconds_filter, 0);
}

TEST(Blocks, PointsThatAreNotFiniteAreErrors) {
  PointCloud cloud = made_clouds()[0];
  PrepareOptions options;
  options.facts = measure_facts(cloud, {});
  options.facts->radius /= 3;  // several blocks: the point has another number in each
  cloud.positions[777].x() = std::nanf("");
  const auto words = [](const auto& act) -> std::string {
    try {
      act();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string expected = "point 777 of 62500 is not finite";
  for (const std::string& told : {words([&] { std::ignore = prepare(cloud, options); }),
                                  words([&] { std::ignore = measure_facts(cloud, {}); })}) {
    EXPECT_NE(told.find(expected), std::string::npos) << told;
  }
}

}  // namespace
}  // namespace palpate
