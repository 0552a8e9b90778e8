#include "apps/palpate/info/density_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "apps/palpate/sources/cloud_facts.hpp"

namespace palpate::app {

namespace {

constexpr int kMostRows = 24;
constexpr std::string_view kShades = ".:-=+*#%@";
// From dark blue to yellow in the terminal's palette of 256.
constexpr std::array<int, 9> kColors = {17, 18, 24, 30, 36, 71, 106, 142, 220};

// A count's step: each is a factor of about 1.6 below the next, and the last holds the largest.
std::size_t shade(std::size_t count, std::size_t largest) {
  const double share = static_cast<double>(count) / static_cast<double>(largest);
  const double below = -2 * std::log2(share) / std::log2(2.5);
  const auto steps = static_cast<std::size_t>(below);
  return steps >= kShades.size() ? 0 : kShades.size() - 1 - steps;
}

}  // namespace

DensityMap map_density(const PointCloud& cloud, int columns) {
  const Box box = core_of(cloud);
  const Eigen::Vector3d size = box.size();
  Eigen::Index shortest = 0;
  size.minCoeff(&shortest);
  DensityMap map;
  map.horizontal = shortest == 0 ? 1 : 0;
  map.vertical = shortest == 2 ? 1 : 2;
  const double width = size[map.horizontal];
  const double height = size[map.vertical];
  map.cell = std::max({width / columns, height / (2 * kMostRows), 1e-12});
  map.columns = std::clamp(static_cast<int>(std::ceil(width / map.cell)), 1, columns);
  map.rows = std::clamp(static_cast<int>(std::ceil(height / (2 * map.cell))), 1, kMostRows);
  map.counts.resize(map.place(map.rows, 0));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!box.contains(cloud.point(i))) continue;
    const Eigen::Vector3d p = cloud.point(i) - box.lower;
    const int column = std::min(static_cast<int>(p[map.horizontal] / map.cell), map.columns - 1);
    const int row = std::min(static_cast<int>(p[map.vertical] / (2 * map.cell)), map.rows - 1);
    ++map.counts[map.place(map.rows - 1 - row, column)];
  }
  return map;
}

std::string draw(const DensityMap& map, bool colored) {
  const std::size_t largest = *std::max_element(map.counts.begin(), map.counts.end());
  std::string text;
  for (int row = 0; row < map.rows; ++row) {
    text += "  ";
    for (int column = 0; column < map.columns; ++column) {
      const std::size_t count = map.counts[map.place(row, column)];
      if (count == 0) {
        text += ' ';
      } else if (colored) {
        text += fmt::format("\033[48;5;{}m \033[0m", kColors[shade(count, largest)]);
      } else {
        text += kShades[shade(count, largest)];
      }
    }
    while (text.back() == ' ') text.pop_back();
    text += '\n';
  }
  return text;
}

}  // namespace palpate::app
