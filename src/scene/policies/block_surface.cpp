#include "scene/policies/block_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/parallel.hpp"
#include "scene/policies/block_order.hpp"

namespace palpate {
namespace {

constexpr float kSpacings = 2.5f;  // R in spacings
constexpr float kRows = 2.2f;      // R in the largest distance to a neighbour
constexpr float kSlope = 0.5f;     // of R over distance
constexpr float kShareOfAround = 0.8f;
constexpr int kLargestWindow = 8;  // blocks on either side
constexpr std::size_t kBlocksAtATime = 256;

// Of R, the deviation of a place that is sure: three of it are where a point weighs half, 0.47 R.
constexpr float kSure = 0.157f;

// Density-normalised weights of a surface that goes on on all sides sum to this times R^2 over the
// area of a point (algorithm.md section 4).
float whole_sum(Kernel kernel) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return static_cast<float>(kernel == Kernel::wyvill ? kTurn * 4 / 27 : kTurn / 14);
}

float weight(Kernel kernel, float q) {
  if (kernel == Kernel::wendland) return static_cast<float>(wendland(static_cast<double>(q)).w);
  const float s = 1 - q;
  return s * s * (5 + 4 * s) * (1.0f / 9);
}

// Is there a point to build on? A filter that is fed garbage may put one behind the camera.
bool present(const FilteredDepth& depth, std::size_t block) {
  if (depth.states[block] == BlockState::empty || !(depth.positions[block].z() > 0)) return false;
  const float all = depth.positions[block].sum() + depth.normals[block].sum() +
                    depth.spacings[block] + depth.confidences[block];
  return std::isfinite(all);
}

}  // namespace

void BlockSurface::measure(const FilteredDepth& depth, std::span<const Ball> exact_within) {
  start(depth);
  limit_growth(depth);
  list_rims(depth, exact_within, false);
  weigh_rims(depth);
}

void BlockSurface::measure(const FilteredDepth& depth) {
  start(depth);
  limit_growth(depth);
  list_rims(depth, {}, true);
  weigh_rims(depth);
}

// Radii by spacing, and areas of a surface that goes on on all sides.
void BlockSurface::start(const FilteredDepth& depth) {
  const std::size_t count = depth.size();
  for (auto* column : {&radii_, &areas_}) column->resize(count);
  const auto pitch = static_cast<float>(depth.pitch);
  const float whole = whole_sum(kernel_);
  for (std::size_t b = 0; b < count; ++b) {
    if (!present(depth, b)) {
      radii_[b] = areas_[b] = 0;
      continue;
    }
    const float side = pitch * depth.positions[b].z();
    const float rows = std::max(side, depth.spacings[b]);
    const float area = side * rows;
    radii_[b] = std::max({kSpacings * std::sqrt(area), kRows * rows, minimum_radius_});
    areas_[b] = area / whole;
  }
}

// Two passes over the image carry a small radius to everywhere (a chamfer transform).
void BlockSurface::limit_growth(const FilteredDepth& depth) {
  if (depth.size() == 0) return;
  const auto columns = static_cast<std::size_t>(depth.columns);
  const auto pitch = static_cast<float>(depth.pitch);
  const auto limit = [&](std::size_t b, std::size_t by) {
    // Blocks are at least their pitch apart, so most pairs need no look at where they are.
    const float room = radii_[b] - radii_[by];
    if (room <= kSlope * pitch * depth.positions[b].z() || radii_[by] == 0) return;
    const float way = kSlope * (depth.positions[b] - depth.positions[by]).norm();
    if (way < room) radii_[b] = radii_[by] + way;
  };
  for (std::size_t b = 1; b < depth.size(); ++b) {
    if (b % columns != 0) limit(b, b - 1);
    if (b >= columns) limit(b, b - columns);
  }
  for (std::size_t b = depth.size() - 1; b-- > 0;) {
    if ((b + 1) % columns != 0) limit(b, b + 1);
    if (b + columns < depth.size()) limit(b, b + columns);
  }
}

float BlockSurface::trust(const FilteredDepth& depth, std::size_t block) const {
  if (depth.states[block] != BlockState::fitted) return 1;
  const float sure = kSure * radii_[block];
  const auto precision = [&](std::size_t b) {
    return 1 / (depth.deviations[b] * depth.deviations[b] + sure * sure);
  };
  const float reach = std::max(radii_[block], kDeviations * depth.deviations[block]);
  float count = 0;
  float sum = 0;
  visit_beside(depth.columns, depth.rows, block, [&](std::size_t other) {
    const float apart = depth.positions[other].z() - depth.positions[block].z();
    if (radii_[other] == 0 || std::abs(apart) > reach) return;
    ++count;
    sum += precision(other);
  });
  return sum > 0 ? std::min(1.0f, precision(block) * count / sum) : 1.0f;
}

// How many blocks of the rectangle from the image's first block to each are empty or lie beside
// another surface.
void BlockSurface::mark_rims(const FilteredDepth& depth) {
  const auto columns = static_cast<std::size_t>(depth.columns);
  const auto rows = static_cast<std::size_t>(depth.rows);
  const std::size_t width = columns + 1;
  rims_.resize(width * (rows + 1));
  std::fill_n(rims_.begin(), width, 0);
  const auto apart = [&](std::size_t b, std::size_t other) {
    return std::abs(depth.positions[b].z() - depth.positions[other].z()) > radii_[b];
  };
  for (std::size_t v = 0; v < rows; ++v) {
    std::int32_t in_row = 0;
    rims_[(v + 1) * width] = 0;
    for (std::size_t u = 0; u < columns; ++u) {
      const std::size_t b = v * columns + u;
      const bool rim =
          radii_[b] == 0 || (u > 0 && apart(b, b - 1)) || (v > 0 && apart(b, b - columns));
      in_row += rim ? 1 : 0;
      rims_[(v + 1) * width + u + 1] = rims_[v * width + u + 1] + in_row;
    }
  }
}

int BlockSurface::half_window(const FilteredDepth& depth, std::size_t block) const {
  const double side = depth.pitch * static_cast<double>(depth.positions[block].z());
  const double half = std::ceil(static_cast<double>(radii_[block]) / side);
  const double asked = std::ceil(static_cast<double>(minimum_radius_) / side);
  return static_cast<int>(std::clamp(half, 1.0, std::max<double>(kLargestWindow, asked)));
}

bool BlockSurface::near_rim(const FilteredDepth& depth, std::size_t block, int half) const {
  const int u = static_cast<int>(block) % depth.columns;
  const int v = static_cast<int>(block) / depth.columns;
  const int left = u - half;
  const int top = v - half;
  const int right = u + half + 1;
  const int bottom = v + half + 1;
  if (left < 0 || top < 0 || right > depth.columns || bottom > depth.rows) return true;
  const auto sum = [&](int x, int y) {
    return rims_[static_cast<std::size_t>(y * (depth.columns + 1) + x)];
  };
  return sum(right, bottom) - sum(left, bottom) - sum(right, top) + sum(left, top) > 0;
}

void BlockSurface::list_rims(const FilteredDepth& depth, std::span<const Ball> exact_within,
                             bool everywhere) {
  exact_.clear();
  if (!everywhere && exact_within.empty()) return;
  mark_rims(depth);
  for (std::size_t b = 0; b < depth.size(); ++b) {
    if (radii_[b] == 0) continue;
    const auto inside = [&](const Ball& ball) {
      return (depth.positions[b].cast<double>() - ball.center).squaredNorm() <=
             ball.radius * ball.radius;
    };
    if (!everywhere && std::none_of(exact_within.begin(), exact_within.end(), inside)) continue;
    if (near_rim(depth, b, half_window(depth, b))) {
      exact_.push_back(static_cast<std::uint32_t>(b));
    }
  }
}

template <class Visit>
void BlockSurface::visit_window(const FilteredDepth& depth, std::size_t block,
                                const Visit& visit) const {
  const int half = half_window(depth, block);
  const int u = static_cast<int>(block) % depth.columns;
  const int v = static_cast<int>(block) / depth.columns;
  const Eigen::Vector3f& place = depth.positions[block];
  for (int y = std::max(0, v - half); y <= std::min(depth.rows - 1, v + half); ++y) {
    for (int x = std::max(0, u - half); x <= std::min(depth.columns - 1, u + half); ++x) {
      const auto other = static_cast<std::size_t>(y * depth.columns + x);
      const float radius = radii_[other];
      if (radius == 0) continue;
      const float q = (depth.positions[other] - place).squaredNorm() / (radius * radius);
      if (q < 1) visit(other, weight(kernel_, q));
    }
  }
}

// a_i = 1 / max(S_i, 0.8 Sbar_i).
void BlockSurface::weigh_rims(const FilteredDepth& depth) {
  if (exact_.empty()) return;
  sums_.resize(depth.size());
  for (std::size_t b = 0; b < depth.size(); ++b) {
    sums_[b] = radii_[b] > 0 ? std::max(1.0f, radii_[b] * radii_[b] / areas_[b]) : 0;
  }
  exact_sums_.resize(exact_.size());
  const auto for_exact = [&](const auto& sum_of) {
    detail::parallel_ranges(exact_.size(), kBlocksAtATime, [&](std::size_t k, std::size_t end) {
      for (; k < end; ++k) exact_sums_[k] = sum_of(k);
    });
  };
  for_exact([&](std::size_t k) {
    float sum = 0;
    visit_window(depth, exact_[k], [&](std::size_t, float w) { sum += w; });
    return sum;
  });
  for (std::size_t k = 0; k < exact_.size(); ++k) sums_[exact_[k]] = exact_sums_[k];
  for_exact([&](std::size_t k) {
    float around = 0;
    visit_window(depth, exact_[k], [&](std::size_t other, float w) { around += w * sums_[other]; });
    return std::max(exact_sums_[k], kShareOfAround * around / exact_sums_[k]);
  });
  for (std::size_t k = 0; k < exact_.size(); ++k) {
    const float radius = radii_[exact_[k]];
    areas_[exact_[k]] = radius * radius / exact_sums_[k];
  }
}

}  // namespace palpate
