// Both copies of the joins give the same bits, and the sums that their header says.
#include "geometry/simd/joins.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/cpu.hpp"
#include "field/formulas.hpp"
#include "geometry/clouds.hpp"
#include "geometry/neighborhood_graph.hpp"
#include "palpate/field/field_options.hpp"
#include "prepare/weights.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;
using test::Clouds;

struct Results {
  std::array<simd::Hit, 3001> hits{};
  std::array<simd::Hit, 3001> apart{};
  std::size_t hit_count = 0;
  std::size_t apart_count = 0;
  simd::Row moments[simd::kMoments];
  simd::Row nearest4[4];
  simd::Row nearest8[8];
  simd::Row wyvill[1];
  simd::Row unit[1];
  simd::Row wendland[1];
  simd::Row means[2];
  simd::Planes planes;
};

// Looks within 0.5 for points at least 0.1 above or below the plane, 0.3 aside, or of odd numbers.
simd::Eyes eyes_at(const CellGrid& grid, const simd::Join& join,
                   const std::vector<std::uint32_t>& segments) {
  simd::Eyes eyes = {};
  eyes.squared_slope = 0.25f;
  eyes.segments = segments.data();
  for (std::size_t q = 0; q < join.count; ++q) {
    const Vector3f normal = grid.points()[join.query + q].normalized();
    for (Eigen::Index axis = 0; axis < 3; ++axis) eyes.normal[axis][q] = normal[axis];
    eyes.squared_reach[q] = 0.25f;
    eyes.least[q] = 0.1f;
    eyes.squared_tube[q] = 0.09f;
    eyes.squared_vote[q] = q % 2 == 0 ? 0.01f : -1.f;
    eyes.segment[q] = segments[join.query + q];
  }
  return eyes;
}

detail::NeighborhoodGraph graph_of(const CellGrid& grid, float reach) {
  return detail::NeighborhoodGraph(grid, std::vector<float>(grid.size(), reach));
}

WeightSums sums_of(const CellGrid& grid, const std::vector<float>& radii,
                   Kernel kernel = Kernel::wyvill) {
  return {detail::NeighborhoodGraph(grid, radii, radii), radii, kernel};
}

std::vector<std::uint32_t> two_segments(std::size_t count) {
  std::vector<std::uint32_t> segments(count);
  for (std::uint32_t i = 0; i < count; ++i) segments[i] = i % 3 == 0 ? 1 : 0;
  return segments;
}

Results run(const simd::JoinFunctions& joins, const simd::Join& join, const std::vector<float>& a,
            const std::vector<float>& b, const simd::Eyes& eyes) {
  Results results;
  results.apart_count = joins.apart(join, eyes, results.apart.data());
  results.hit_count = joins.within(join, a.data() + join.query, results.hits.data());
  joins.moments(join, a.data() + join.query, results.moments);
  joins.nearest4(join, results.nearest4);
  joins.nearest8_apart(join, results.nearest8);
  joins.wyvill_sums(join, a.data(), b.data(), results.wyvill);
  joins.wyvill_sums(join, a.data(), nullptr, results.unit);
  joins.wendland_sums(join, a.data(), b.data(), results.wendland);
  joins.wyvill_means(join, a.data() + join.query, b.data(), results.means);
  joins.planes(results.moments, &results.planes);
  return results;
}

TEST(Joins, AreTheSameBitForBitOnEveryProcessor) {
  if (!cpu_has_v3()) GTEST_SKIP() << "this processor lacks AVX2";
  Clouds clouds;
  const CellGrid grid(clouds.sphere(3000, 1));
  std::vector<float> a(grid.size() + simd::kQueries);
  std::vector<float> b = a;
  for (float& v : a) v = static_cast<float>(clouds.uniform(0.01, 0.3));
  for (float& v : b) v = static_cast<float>(clouds.uniform(0.5, 2));
  const std::vector<std::uint32_t> segments = two_segments(grid.size());
  graph_of(grid, 0.4f).for_each_row([&](const detail::NeighborRow& row) {
    const simd::Join join = row.join(grid);
    const simd::Eyes eyes = eyes_at(grid, join, segments);
    const Results old = run(simd::kJoinsBaseline, join, a, b, eyes);
    const Results now = run(simd::kJoinsV3, join, a, b, eyes);
    EXPECT_EQ(std::memcmp(&old, &now, sizeof old), 0);
  });
}

TEST(Joins, FindAllHitsInRisingOrder) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(2001, 1));  // no multiple of the queries
  std::vector<float> radii(grid.size());
  std::vector<float> squared(grid.size() + simd::kQueries);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    radii[i] = static_cast<float>(clouds.uniform(0.01, 0.3));
    squared[i] = radii[i] * radii[i];
  }
  graph_of(grid, 0.3f).for_each_row([&](const detail::NeighborRow& row) {
    std::vector<simd::Hit> hits(grid.size() + 1);
    const std::size_t found =
        simd::best_joins().within(row.join(grid), squared.data() + row.first, hits.data());
    std::size_t pairs = 0;
    for (std::size_t h = 0; h < found; ++h) {
      EXPECT_TRUE(h == 0 || hits[h].candidate > hits[h - 1].candidate);
      EXPECT_LT(hits[h].queries, 1u << row.count);
      pairs += static_cast<std::size_t>(std::popcount(hits[h].queries));
    }
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i) {
      grid.within(grid.points()[i], radii[i], near);
    }
    EXPECT_EQ(pairs, near.size());
  });
}

TEST(Joins, FindWhatIsOffAPlaneOrOnAnotherSegment) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(1003, 0.5));
  const std::vector<std::uint32_t> segments = two_segments(grid.size());
  graph_of(grid, 0.5f).for_each_row([&](const detail::NeighborRow& row) {
    const simd::Join join = row.join(grid);
    const simd::Eyes eyes = eyes_at(grid, join, segments);
    std::vector<simd::Hit> hits(grid.size() + 1);
    std::vector<std::uint32_t> found(grid.size());
    const std::size_t n = simd::best_joins().apart(join, eyes, hits.data());
    for (std::size_t h = 0; h < n; ++h) found[hits[h].candidate] = hits[h].queries;
    for (std::uint32_t j = 0; j < grid.size(); ++j) {
      for (std::uint32_t q = 0; q < row.count; ++q) {
        const Vector3f& p = grid.points()[row.first + q];
        const Vector3f way = grid.points()[j] - p;
        const float height = p.normalized().dot(way);
        const float aside = way.squaredNorm() - height * height;
        const bool off =
            std::abs(height) > 0.1f && aside <= 0.09f && height * height >= 0.25f * aside;
        const bool other =
            q % 2 == 0 && way.squaredNorm() <= 0.01f && segments[j] != segments[row.first + q];
        const bool near = detail::squared_distance(grid.points()[j], p) <= 0.25f;
        EXPECT_EQ((found[j] >> q & 1) != 0, near && (off || other));
      }
    }
  });
}

// S_i and Sbar_i in double precision over all pairs.
void expect_sums(const CellGrid& grid, const std::vector<float>& radii, Kernel kernel) {
  const auto weight = [&](std::size_t i, std::size_t j) {
    const double d = (grid.points()[i] - grid.points()[j]).cast<double>().norm() / radii[j];
    return evaluate(kernel, d * d).w;
  };
  std::vector<double> own(grid.size(), 0);
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t j = 0; j < own.size(); ++j) own[i] += weight(i, j);
  }
  const std::vector<float> weights = density_weights(sums_of(grid, radii, kernel));
  for (std::size_t i = 0; i < own.size(); ++i) {
    double around = 0;
    for (std::size_t j = 0; j < own.size(); ++j) around += weight(i, j) * own[j];
    EXPECT_NEAR(weights[i] * std::max(own[i], 0.8 * around / own[i]), 1, 1e-4);
  }
}

TEST(DensityWeights, EqualBruteForceWithUnevenRadii) {
  Clouds clouds;
  const CellGrid grid(clouds.sphere(800, 1));
  std::vector<float> radii(grid.size());
  for (float& r : radii) r = static_cast<float>(clouds.uniform(0.1, 0.4));
  expect_sums(grid, radii, Kernel::wyvill);
  expect_sums(grid, radii, Kernel::wendland);
}

TEST(DensityWeights, MakeAPlaneWeighAboutOneHoweverDense) {
  for (const double spacing : {1e-3, 4e-3}) {
    for (const double multiple : {2., 2.5, 4.}) {
      const CellGrid grid(Clouds(3).plane(40, spacing, 0.2));
      const auto radius = static_cast<float>(multiple * spacing);
      const std::vector<float> radii(grid.size(), radius);
      const std::vector<float> weights = density_weights(sums_of(grid, radii));
      std::vector<std::uint32_t> near;
      const auto middle = static_cast<float>(19.5 * spacing);
      grid.within(Vector3f(middle, middle, 0), radius, near);
      double sum = 0;
      for (const auto i : near) {
        const double r = (grid.points()[i] - Vector3f(middle, middle, 0)).norm() / radius;
        sum += static_cast<double>(weights[i]) * wyvill(r * r).w;
      }
      EXPECT_NEAR(sum, 1, 0.08) << spacing << " " << multiple;
    }
  }
}

TEST(DensityWeights, AreFiniteForCoincidentPointsAndTinyRadii) {
  const CellGrid grid(std::vector<Vector3f>(300, Vector3f(1, 2, 3)));
  for (const float radius : {1e-30f, 1e-3f, 1e18f}) {
    const auto weights = density_weights(sums_of(grid, std::vector<float>(300, radius)));
    ASSERT_EQ(weights.size(), 300u);
    for (const float w : weights) EXPECT_NEAR(w, 1. / 300, 1e-6);
  }
}

}  // namespace
}  // namespace palpate
