// Weighs the points of a depth frame that lie beside rims and holes.
#include "stream/block_rims.hpp"

#include <algorithm>
#include <cmath>

#include "stream/simd/rims.hpp"

namespace palpate {
namespace {

// Least weight of a rim beside the mean of its neighbours (docs/method.md 2.2).
constexpr float kShareOfAround = 0.8f;

/// Are the blocks at `at` outside of a ball, by more than single precision may err?
bool are_far(const PaddedBlocks& padded, std::size_t at, const Ball& ball) {
  const Vectors position{load<Floats>(&padded.x[at]), load<Floats>(&padded.y[at]),
                         load<Floats>(&padded.z[at])};
  const Vectors offset = position - all_lanes(ball.center.cast<float>());
  const double reach = 1.001 * ball.radius + 1e-5 * ball.center.norm();
  return all(dot(offset, offset) > static_cast<float>(reach * reach));
}

}  // namespace

// Forgets the rims of the frame before. Counts for each block how many of the rectangle from the
// image's first block to it are empty or lie beside another surface.
void BlockRims::mark(const FilteredDepth& depth, std::span<const float> of,
                     const PaddedBlocks& padded) {
  halves_.assign(depth.size() + simd::kRimLanes, 0);
  row_halves_.assign(static_cast<std::size_t>(depth.rows), 0);
  const std::ptrdiff_t columns = depth.columns;
  const auto width = static_cast<std::size_t>(columns + 1);
  rims_.resize(width * (static_cast<std::size_t>(depth.rows) + 1));
  std::fill_n(rims_.begin(), width, 0);
  each_row(depth, [&](std::size_t v) {
    std::int32_t* const sums = &rims_[(v + 1) * width];
    sums[0] = 0;
    const float* const z = &padded.z[padded.index(0, static_cast<int>(v))];
    const float* const above = z - padded.stride;
    const float* const radii = &of[v * (width - 1)];
    for (std::ptrdiff_t u = 0; u < columns; ++u) {
      const float radius = radii[u];
      const bool aside = (u > 0) & (std::abs(z[u] - z[u - 1]) > radius);
      const bool below = (v > 0) & (std::abs(z[u] - above[u]) > radius);
      sums[u + 1] = sums[u] + static_cast<int>((radius == 0) | aside | below);
    }
  });
  for (std::size_t k = width; k < rims_.size(); ++k) rims_[k] += rims_[k - width];
}

int BlockRims::half_window(const FilteredDepth& depth, std::size_t block, float radius) const {
  const double side = depth.pitch * static_cast<double>(depth.positions[block].z());
  const double half = std::ceil(static_cast<double>(radius) / side);
  const double requested = std::ceil(static_cast<double>(minimum_radius_) / side);
  return static_cast<int>(std::clamp(half, 1.0, std::max<double>(kLargestWindow, requested)));
}

bool BlockRims::near_rim(const FilteredDepth& depth, std::size_t block, int half) const {
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

void BlockRims::find(const FilteredDepth& depth, std::span<const float> radii,
                     const PaddedBlocks& padded, const HiddenPlanes& hidden,
                     std::span<const Ball> balls, Exact exact, bool whole) {
  largest_half_ = 0;
  if (exact == Exact::nowhere) return;
  mark(depth, radii, padded);
  const auto columns = static_cast<std::size_t>(depth.columns);
  // Most blocks are far outside.
  const auto all_far = [&](std::size_t at) {
    return std::all_of(balls.begin(), balls.end(),
                       [&](const Ball& b) { return are_far(padded, at, b); });
  };
  each_other(depth, whole, [&](int v, int first, int count) {
    const std::size_t row = static_cast<std::size_t>(v) * columns;
    const std::size_t end = row + first + count;
    for (std::size_t b = row + first; b < end; ++b) {
      const std::size_t at = padded.index(static_cast<int>(b - row), v);
      if (exact == Exact::within && b + kLanes <= end && all_far(at)) {
        b += kLanes - 1;
        continue;
      }
      if (radii[b] == 0 || hidden.joins(b)) continue;
      const auto inside = [&](const Ball& ball) {
        return (depth.positions[b].cast<double>() - ball.center).squaredNorm() <=
               ball.radius * ball.radius;
      };
      if (exact == Exact::within && std::none_of(balls.begin(), balls.end(), inside)) continue;
      const int half = half_window(depth, b, radii[b]);
      if (!near_rim(depth, b, half)) continue;
      halves_[b] = half;
      row_halves_[v] = std::max(row_halves_[v], half);
    }
  });
  for (const int half : row_halves_) largest_half_ = std::max(largest_half_, half);
}

// Calls take(block, index, sum) for each block whose sum over what is around it is wanted: of
// weights times what stands in `factors`.
template <class Take>
void BlockRims::sum_around(const FilteredDepth& depth, const PaddedBlocks& padded,
                           const float* factors, const Take& take) const {
  const simd::RimFunctions& best = simd::best_rims();
  const auto row = [&](int v) {
    for (int u = 0; u < depth.columns; u += simd::kRimLanes) {
      const std::size_t first = static_cast<std::size_t>(v) * depth.columns + u;
      const std::int32_t* const halves = &halves_[first];
      if (std::all_of(halves, halves + simd::kRimLanes, [](int half) { return half == 0; }))
        continue;
      const std::size_t at = padded.index(u, v);
      float sums[simd::kRimLanes];
      best.around({&padded.x[at], &padded.y[at], &padded.z[at], &padded.per_r2[at], factors + at,
                   static_cast<std::ptrdiff_t>(padded.stride)},
                  kernel_ == Kernel::wendland, halves, sums);
      for (int l = 0; l < std::min(simd::kRimLanes, depth.columns - u); ++l) {
        if (halves[l] > 0) take(first + l, at + l, sums[l]);
      }
    }
  };
  each_row(depth, [&](std::size_t v) {
    if (row_halves_[v] > 0) row(static_cast<int>(v));
  });
}

// a_i = 1 / max(S_i, 0.8 Sbar_i).
void BlockRims::weigh(const FilteredDepth& depth, std::span<const float> radii,
                      PaddedBlocks& padded, std::span<float> areas) const {
  sum_around(depth, padded, padded.ones.data(),
             [&](std::size_t, std::size_t at, float sum) { padded.sums[at] = sum; });
  sum_around(
      depth, padded, padded.sums.data(), [&](std::size_t block, std::size_t at, float around) {
        const float sum = std::max(padded.sums[at], kShareOfAround * around / padded.sums[at]);
        areas[block] = radii[block] * radii[block] / sum;
      });
}

}  // namespace palpate
