// Makes clouds for the tests of stores.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/numbers.hpp"
#include "extras/tile/tile.hpp"
#include "io/las_bytes.hpp"
#include "io/store_reading.hpp"

namespace palpate {

/// Small ones, so that small clouds have several chunks and levels.
inline io::tile::TileOptions small_options() {
  io::tile::TileOptions options;
  options.chunk_points = 3000;
  options.leaf_points = 200;
  return options;
}

/// A hilly ground of 600 x 300 steps of 0.1 m with twins, and a wall.
inline std::vector<LasPoint> ground(std::size_t count, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<LasPoint> points(count);
  for (LasPoint& p : points) {
    const auto x = static_cast<std::int32_t>(6000 * random.uniform());
    const auto y = static_cast<std::int32_t>(3000 * random.uniform());
    const double height = 200 * std::sin(x * 0.003) * std::cos(y * 0.002);
    const bool wall = y > 1500 && y < 1510;
    p.number = {x, y, static_cast<std::int32_t>(wall ? 900 * random.uniform() : height)};
    p.intensity = static_cast<std::uint16_t>(1 + 999 * random.uniform());
    for (auto& c : p.color) c = static_cast<std::uint16_t>(300 + 65000 * random.uniform());
  }
  for (std::size_t i = 0; i + 1 < count; i += 97) points[i + 1] = points[i];
  return points;
}

/// Points of an input in the numbers of the store, whose corner is at the lowest of them.
inline std::vector<test::Stored> expected_of(const std::vector<LasPoint>& points) {
  std::vector<test::Stored> all;
  for (const LasPoint& p : points) {
    if (p.withheld) continue;
    all.push_back({{p.number[0], p.number[1], p.number[2]}, p.intensity, p.color});
  }
  std::array<std::int64_t, 3> lowest = all.front().number;
  for (const test::Stored& each : all) {
    for (std::size_t k = 0; k < 3; ++k) lowest[k] = std::min(lowest[k], each.number[k]);
  }
  for (test::Stored& each : all) {
    for (std::size_t k = 0; k < 3; ++k) each.number[k] -= lowest[k];
  }
  std::ranges::sort(all);
  return all;
}

inline std::string bytes_of(const std::filesystem::path& folder) {
  return test::contents(folder / "octree.bin") + test::contents(folder / "hierarchy.bin") +
         test::contents(folder / "metadata.json");
}

inline std::string tile_refusal(const std::vector<std::string>& inputs,
                                const std::filesystem::path& out,
                                const io::tile::TileOptions& options = small_options()) {
  try {
    io::tile::tile(inputs, out, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace palpate
