#include "prepare/merge_slivers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/filters.hpp"

namespace palpate {
namespace {

constexpr std::uint32_t kNobody = ~std::uint32_t{0};

// For each point the one that it is joined to (itself, for most). The fullest choose first.
std::vector<std::uint32_t> choose_hosts(const PointCloud& cloud,
                                        std::span<const std::uint32_t> counts, double distance) {
  const CellGrid grid(cloud.positions);
  std::vector<std::uint32_t> fullest(cloud.size());
  std::iota(fullest.begin(), fullest.end(), 0u);
  std::stable_sort(fullest.begin(), fullest.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
  std::vector<std::uint32_t> hosts(cloud.size(), kNobody);
  std::vector<std::uint32_t> near;
  for (const std::uint32_t i : fullest) {
    if (hosts[i] != kNobody) continue;
    near.clear();
    grid.within(cloud.positions[i], static_cast<float>(distance), near);
    hosts[i] = i;
    for (const std::uint32_t k : near) {
      std::uint32_t& host = hosts[grid.order()[k]];
      if (host == kNobody) host = i;
    }
  }
  return hosts;
}

// Replaces each host's value by the weighted mean of all that joined it.
template <class T, class ToVector, class FromVector>
void average(std::vector<T>& column, std::span<const std::uint32_t> hosts,
             std::span<const std::uint32_t> counts, const ToVector& to_vector,
             const FromVector& from_vector) {
  if (column.empty()) return;
  std::vector<Eigen::Vector3d> sums(column.size(), Eigen::Vector3d::Zero());
  std::vector<double> weights(column.size());
  for (std::size_t i = 0; i < column.size(); ++i) {
    const double weight = counts[i];
    sums[hosts[i]] += weight * to_vector(column[i]);
    weights[hosts[i]] += weight;
  }
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (hosts[i] == i && weights[i] > counts[i]) column[i] = from_vector(sums[i] / weights[i]);
  }
}

std::array<std::uint8_t, 3> to_color(const Eigen::Vector3d& mean) {
  std::array<std::uint8_t, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(std::lround(mean[static_cast<Eigen::Index>(c)]));
  }
  return color;
}

}  // namespace

PointCloud merge_slivers(const PointCloud& cloud, double distance,
                         std::vector<std::uint32_t>& counts) {
  const std::vector<std::uint32_t> hosts = choose_hosts(cloud, counts, distance);
  PointCloud merged = cloud;
  const auto widen = [](const Eigen::Vector3f& v) -> Eigen::Vector3d { return v.cast<double>(); };
  const auto narrow = [](const Eigen::Vector3d& v) -> Eigen::Vector3f { return v.cast<float>(); };
  average(merged.positions, hosts, counts, widen, narrow);
  average(merged.normals, hosts, counts, widen, [&](const Eigen::Vector3d& v) -> Eigen::Vector3f {
    return v.norm() > 1e-6 ? narrow(v.normalized()) : Eigen::Vector3f::Zero();
  });
  average(
      merged.colors, hosts, counts,
      [](const std::array<std::uint8_t, 3>& c) { return Eigen::Vector3d(c[0], c[1], c[2]); },
      to_color);
  average(
      merged.intensities, hosts, counts, [](float v) { return Eigen::Vector3d(v, 0, 0); },
      [](const Eigen::Vector3d& v) { return static_cast<float>(v.x()); });
  std::vector<std::uint32_t> sums(counts.size());
  for (std::size_t i = 0; i < hosts.size(); ++i) sums[hosts[i]] += counts[i];
  std::vector<std::uint32_t> kept;
  counts.clear();
  for (std::uint32_t i = 0; i < hosts.size(); ++i) {
    if (hosts[i] != i) continue;
    kept.push_back(i);
    counts.push_back(sums[i]);
  }
  return select(merged, kept);
}

}  // namespace palpate
