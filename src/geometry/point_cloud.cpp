// Selects, clips and voxel-filters point clouds.
#include "palpate/geometry/point_cloud.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "geometry/elements_at.hpp"
#include "geometry/parallel.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
PointCloud select(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
  PointCloud result;
  result.origin = cloud.origin;
  result.viewpoint = cloud.viewpoint;
  result.positions = detail::elements_at(cloud.positions, indices);
  result.normals = detail::elements_at(cloud.normals, indices);
  result.colors = detail::elements_at(cloud.colors, indices);
  result.intensities = detail::elements_at(cloud.intensities, indices);
  return result;
}

PointCloud clip(const PointCloud& cloud, const Box& box) {
  std::vector<std::uint32_t> inside;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (box.contains(cloud.point(i))) inside.push_back(static_cast<std::uint32_t>(i));
  }
  return select(cloud, inside);
}

namespace {

using detail::kIndexBits;
using detail::kIndexMask;
using detail::kKeyBits;
using detail::Record;

constexpr std::size_t kVoxelGrain = std::size_t{1} << 16;  // points of a thread's share (judgement)
constexpr double kMaxCubes = 1 << 21;  // along an axis: three such numbers fit in 63 bits

// Grid of cubes, and the key of each cube.
struct Lattice {
  double leaf = 0;                                  // m
  Eigen::Vector3d first = Eigen::Vector3d::Zero();  // lowest cube, in leaves
  std::array<int, 3> bits{};                        // that count the cubes along each axis

  [[nodiscard]] int key_bits() const { return bits[0] + bits[1] + bits[2]; }
  [[nodiscard]] std::uint64_t key(const Eigen::Vector3f& p) const {
    const auto cube = [&](Eigen::Index axis) {
      return static_cast<std::uint64_t>(std::floor(static_cast<double>(p[axis]) / leaf) -
                                        first[axis]);
    };
    return (cube(2) << bits[1] | cube(1)) << bits[0] | cube(0);
  }
};

Lattice make_lattice(const PointCloud& cloud, double leaf) {
  if (!(leaf > 0) || !std::isfinite(leaf)) {
    throw Error(
        fmt::format("voxel filter: the leaf size is {} m; it must be positive and finite", leaf));
  }
  Lattice lattice;
  lattice.leaf = leaf;
  if (cloud.empty()) return lattice;
  Eigen::Vector3f lower = cloud.positions.front();
  Eigen::Vector3f upper = lower;
  for (const Eigen::Vector3f& p : cloud.positions) {
    if (!p.allFinite()) {
      throw Error(fmt::format("voxel filter: a point ({}, {}, {}) is not finite; drop such points",
                              p.x(), p.y(), p.z()));
    }
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    lattice.first[axis] = std::floor(static_cast<double>(lower[axis]) / leaf);
    const double last = std::floor(static_cast<double>(upper[axis]) / leaf);
    const double cubes = last - lattice.first[axis] + 1;
    if (!(cubes <= kMaxCubes)) {
      const double length = static_cast<double>(upper[axis]) - static_cast<double>(lower[axis]);
      throw Error(
          fmt::format("voxel filter: a leaf size of {} m divides a cloud of {:.3g} m into {:.3g} "
                      "voxels along one axis, more than {}; give {:.3g} m or more",
                      leaf, length, cubes, kMaxCubes, 1.01 * length / kMaxCubes));
    }
    lattice.bits[static_cast<std::size_t>(axis)] =
        std::bit_width(static_cast<std::uint32_t>(cubes) - 1);
  }
  return lattice;
}

// Sorts by key bits [shift, shift + bits), keeping the order of equal ones. index_of(i): the point
// that is i-th so far.
template <class IndexOf>
std::vector<Record> sort_by(const PointCloud& cloud, const Lattice& lattice, int shift, int bits,
                            const IndexOf& index_of) {
  std::vector<Record> records(cloud.size());
  detail::parallel_each(records.size(), kVoxelGrain, [&](std::size_t i) {
    const std::uint64_t key = lattice.key(cloud.positions[index_of(i)]) >> shift;
    records[i] = key << (kIndexBits + kKeyBits - bits) | i;
  });
  std::vector<Record> scratch(records.size());
  detail::sort_records(records, scratch, bits);
  return records;
}

// The points' indices, cube by cube, in the input's order within a cube.
std::vector<std::uint32_t> sort_indices(const PointCloud& cloud, const Lattice& lattice) {
  const int bits = std::max(1, lattice.key_bits());
  const int low_bits = std::min(bits, kKeyBits);
  std::vector<std::uint32_t> indices(cloud.size());
  const auto low = sort_by(cloud, lattice, 0, low_bits, [](std::size_t i) { return i; });
  for (std::size_t i = 0; i < indices.size(); ++i) {
    indices[i] = static_cast<std::uint32_t>(low[i] & kIndexMask);
  }
  if (bits == low_bits) return indices;
  const auto high =
      sort_by(cloud, lattice, low_bits, bits - low_bits, [&](std::size_t i) { return indices[i]; });
  std::vector<std::uint32_t> sorted(indices.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = indices[high[i] & kIndexMask];
  return sorted;
}

// Index in `indices` where each cube's points begin, and where the last cube's end.
std::vector<std::uint32_t> find_cubes(const PointCloud& cloud, const Lattice& lattice,
                                      std::span<const std::uint32_t> indices) {
  std::vector<std::uint32_t> starts;
  std::uint64_t previous = ~std::uint64_t{0};
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint64_t key = lattice.key(cloud.positions[indices[i]]);
    if (key != previous) starts.push_back(static_cast<std::uint32_t>(i));
    previous = key;
  }
  starts.push_back(static_cast<std::uint32_t>(indices.size()));
  return starts;
}

// Double sums, whatever the column's type.
template <class Column>
Eigen::Vector3d sum_of(const Column& column, std::span<const std::uint32_t> indices) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : indices) {
    sum += Eigen::Vector3d(static_cast<double>(column[i][0]), static_cast<double>(column[i][1]),
                           static_cast<double>(column[i][2]));
  }
  return sum;
}

void average(const PointCloud& cloud, std::span<const std::uint32_t> indices, std::size_t cube,
             PointCloud& result) {
  const auto count = static_cast<double>(indices.size());
  result.positions[cube] = (sum_of(cloud.positions, indices) / count).cast<float>();
  if (!cloud.normals.empty()) {
    const Eigen::Vector3d sum = sum_of(cloud.normals, indices);
    const double length = sum.norm();
    const bool cancelled = !(length > 1e-6 * count);
    result.normals[cube] =
        cancelled ? Eigen::Vector3f::Zero() : Eigen::Vector3f((sum / length).cast<float>());
  }
  if (!cloud.colors.empty()) {
    const Eigen::Vector3d mean = sum_of(cloud.colors, indices) / count;
    for (std::size_t c = 0; c < 3; ++c) {
      result.colors[cube][c] =
          static_cast<std::uint8_t>(std::lround(mean[static_cast<Eigen::Index>(c)]));
    }
  }
  if (!cloud.intensities.empty()) {
    double sum = 0;
    for (const std::uint32_t i : indices) sum += static_cast<double>(cloud.intensities[i]);
    result.intensities[cube] = static_cast<float>(sum / count);
  }
}

}  // namespace

PointCloud voxel_downsample(const PointCloud& cloud, double leaf,
                            std::vector<std::uint32_t>* counts) {
  PointCloud result;
  result.origin = cloud.origin;
  result.viewpoint = cloud.viewpoint;
  if (cloud.size() > kIndexMask) {
    throw Error(fmt::format("voxel filter: {} points exceed the limit of {}; split the cloud",
                            cloud.size(), kIndexMask));
  }
  const Lattice lattice = make_lattice(cloud, leaf);
  const std::vector<std::uint32_t> indices = sort_indices(cloud, lattice);
  const std::vector<std::uint32_t> starts = find_cubes(cloud, lattice, indices);
  const std::size_t cubes = starts.size() - 1;
  if (counts) {
    counts->resize(cubes);
    for (std::size_t cube = 0; cube < cubes; ++cube) {
      (*counts)[cube] = starts[cube + 1] - starts[cube];
    }
  }
  result.positions.resize(cubes);
  result.normals.resize(cloud.normals.empty() ? 0 : cubes);
  result.colors.resize(cloud.colors.empty() ? 0 : cubes);
  result.intensities.resize(cloud.intensities.empty() ? 0 : cubes);
  detail::parallel_each(cubes, kVoxelGrain / 16, [&](std::size_t cube) {
    const auto inside = std::span(indices).subspan(starts[cube], starts[cube + 1] - starts[cube]);
    average(cloud, inside, cube, result);
  });
  return result;
}

}  // namespace palpate
