// Measures radii, areas and precisions of the points of a depth frame.
#include "scene/policies/block_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/policies/lanes.hpp"

namespace palpate {
namespace {

// Radii of blocks as surface points (docs/method.md 6.7; judgement).
constexpr float kSpacings = 2.5f;  // R in spacings
constexpr float kRows = 2.2f;      // R in the largest distance to a neighbour
constexpr float kSlope = 0.5f;     // of R over distance
constexpr float kNowhere = 1e30f;  // 1 / R^2 of no point, 1/m^2

// Deviation of a place that is sure, in R: three of it are where a point weighs half, 0.47 R
// (derived; docs/method.md 6.7).
constexpr float kSure = 0.157f;

// Density-normalised weights of a surface that goes on on all sides sum to this times R^2 over the
// area of a point (docs/method.md 6.7).
float whole_sum(Kernel kernel) {
  constexpr double kTurn = 2 * std::numbers::pi;  // rad
  return static_cast<float>(kernel == Kernel::wyvill ? kTurn * 4 / 27 : kTurn / 14);
}

// Is there a point to build on? A filter that is fed garbage may put one behind the camera.
bool present(const FilteredDepth& depth, std::size_t block) {
  if (depth.states[block] == FilteredDepth::State::empty || !(depth.positions[block].z() > 0))
    return false;
  const float all = depth.positions[block].sum() + depth.normals[block].sum() +
                    depth.spacings[block] + depth.confidences[block];
  return std::isfinite(all);
}

template <class Lanes>
void put(std::vector<float>& column, std::size_t at, const Lanes& lanes) {
  store(&column[at], lanes);
}

}  // namespace

void BlockSurface::measure(const FilteredDepth& depth, std::span<const Ball> exact_within) {
  measure(depth, exact_within, exact_within.empty() ? Exact::nowhere : Exact::within);
}

void BlockSurface::measure(const FilteredDepth& depth) {
  measure(depth, {}, Exact::everywhere);
}

void BlockSurface::measure(const FilteredDepth& depth, std::span<const Ball> balls, Exact exact) {
  make_room(depth, std::max(margin_, kLargestWindow));
  start(depth);
  limit_growth(depth);
  list_rims(depth, balls, exact);
  if (largest_half_ > margin_) {
    make_room(depth, largest_half_);
    each_row(depth, [&](std::size_t v) { lay_out_places(depth, v); });
  }
  each_row(depth, [&](std::size_t v) { lay_out(depth, v); });
  each_row(depth, [&](std::size_t v) { trust_row(depth, v); });
  if (largest_half_ > 0) weigh_rims(depth);
}

// Radii by spacing, and areas of a surface that goes on on all sides.
void BlockSurface::start(const FilteredDepth& depth) {
  const std::size_t count = depth.size();
  for (auto* column : {&radii_, &areas_, &trusts_}) column->resize(count + kLanes);
  halves_.assign(count + kLanes, 0);
  row_halves_.assign(static_cast<std::size_t>(depth.rows), 0);
  const auto pitch = static_cast<float>(depth.pitch);
  const float whole = whole_sum(kernel_);
  const auto columns = static_cast<std::size_t>(depth.columns);
  each_row(depth, [&](std::size_t v) {
    lay_out_places(depth, v);
    for (std::size_t b = v * columns; b < (v + 1) * columns; ++b) {
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
  });
}

// Two passes over the image carry a small radius to everywhere (a chamfer transform).
void BlockSurface::limit_growth(const FilteredDepth& depth) {
  carry(depth, 1);
  carry(depth, -1);
}

// Forwards (1) or backwards (-1). Blocks are at least their pitch apart, so most pairs need no look
// at where they are.
void BlockSurface::carry(const FilteredDepth& depth, std::ptrdiff_t sign) {
  const std::ptrdiff_t columns = depth.columns;
  const float step = kSlope * static_cast<float>(depth.pitch);
  const auto may_limit = [&](std::ptrdiff_t b, std::ptrdiff_t by, std::size_t at) {
    const auto other = load<Floats>(&radii_[b + by]);
    const Floats room = load<Floats>(&radii_[b]) - other;
    return any((room > step * load<Floats>(&z_[at])) & (other != 0));
  };
  const auto limit = [&](std::ptrdiff_t b, std::ptrdiff_t by) {
    const float room = radii_[b] - radii_[by];
    if (room <= step * depth.positions[b].z() || radii_[by] == 0) return;
    const float way = kSlope * (depth.positions[b] - depth.positions[by]).norm();
    if (way < room) radii_[b] = radii_[by] + way;
  };
  for (std::ptrdiff_t row = 0; row < depth.rows; ++row) {
    const auto v = static_cast<int>(sign > 0 ? row : depth.rows - 1 - row);
    for (std::ptrdiff_t k = 0; k < columns;) {
      const std::ptrdiff_t u = sign > 0 ? k : columns - 1 - k;
      const std::ptrdiff_t b = v * columns + u;
      const std::ptrdiff_t skip = sign > 0 ? 0 : kLanes - 1;  // to the first of those side by side
      if (k > 0 && row > 0 && k + kLanes <= columns &&
          !may_limit(b - skip, -sign, place(static_cast<int>(u - skip), v)) &&
          !may_limit(b - skip, -sign * columns, place(static_cast<int>(u - skip), v))) {
        k += kLanes;
        continue;
      }
      if (k > 0) limit(b, b - sign);
      if (row > 0) limit(b, b - sign * columns);
      ++k;
    }
  }
}

// Makes room for the columns, with a margin of so many empty blocks all around.
void BlockSurface::make_room(const FilteredDepth& depth, int margin) {
  const auto stride = static_cast<std::size_t>(depth.columns + 2 * margin);
  const std::size_t size = stride * static_cast<std::size_t>(depth.rows + 2 * margin) + kLanes;
  if (margin == margin_ && stride == stride_ && size == x_.size()) return;
  margin_ = margin;
  stride_ = stride;
  for (auto* column : {&x_, &y_, &z_, &reaches_, &precisions_, &sums_}) column->assign(size, 0);
  per_r2_.assign(size, kNowhere);
  ones_.assign(size, 1);
}

void BlockSurface::lay_out_places(const FilteredDepth& depth, std::size_t v) {
  const auto columns = static_cast<std::size_t>(depth.columns);
  const Eigen::Vector3f* position = depth.positions.data() + v * columns;
  const std::size_t first = place(0, static_cast<int>(v));
  for (std::size_t at = first; at < first + columns; ++at) {
    x_[at] = position->x();
    y_[at] = position->y();
    z_[at] = position->z();
    ++position;
  }
}

// Puts side by side what sums over neighbours need.
void BlockSurface::lay_out(const FilteredDepth& depth, std::size_t v) {
  std::size_t at = place(0, static_cast<int>(v));
  std::size_t b = v * static_cast<std::size_t>(depth.columns);
  const auto take = [&](const auto& radius, const auto& deviation, const auto& area, auto lanes) {
    using Lanes = decltype(lanes);
    const Lanes sure = kSure * radius;
    const Lanes spread = kDeviations * deviation;
    const Lanes sum = radius * radius / area;
    const Lanes precision = 1 / (deviation * deviation + sure * sure);
    const auto there = radius > 0;
    const Lanes nothing{};
    put(reaches_, at, radius < spread ? spread : radius);
    put(per_r2_, at, there ? 1 / (radius * radius) : nothing + kNowhere);
    put(precisions_, at, there ? precision : nothing);
    put(sums_, at, there ? (1 < sum ? sum : nothing + 1) : nothing);
  };
  int u = 0;
  for (; u + kLanes <= depth.columns; u += kLanes, at += kLanes, b += kLanes) {
    take(load<Floats>(&radii_[b]), load<Floats>(&depth.deviations[b]), load<Floats>(&areas_[b]),
         Floats{});
  }
  for (; u < depth.columns; ++u, ++at, ++b) {
    take(radii_[b], depth.deviations[b], areas_[b], 0.0f);
  }
}

void BlockSurface::trust_row(const FilteredDepth& depth, std::size_t v) {
  const std::size_t first = v * static_cast<std::size_t>(depth.columns);
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  const std::ptrdiff_t beside[] = {-stride - 1, -stride,    -stride + 1, -1,
                                   1,           stride - 1, stride,      stride + 1};
  for (int u = 0; u < depth.columns; u += kLanes) {
    const float* const z = &z_[place(u, static_cast<int>(v))];
    const float* const precisions = &precisions_[place(u, static_cast<int>(v))];
    const auto own = load<Floats>(precisions);
    const auto reach = load<Floats>(&reaches_[place(u, static_cast<int>(v))]);
    Floats count{};
    Floats sum{};
    for (const std::ptrdiff_t by : beside) {
      const auto precision = load<Floats>(precisions + by);
      const Floats apart = load<Floats>(z + by) - load<Floats>(z);
      const Ints same = (precision > 0) & (apart <= reach) & (-apart <= reach);
      count -= __builtin_convertvector(same, Floats);
      sum += same ? precision : Floats{};
    }
    const Floats trust = sum > 0 ? own * count / sum : Floats{} + 1;
    for (int l = 0; l < std::min(kLanes, depth.columns - u); ++l) {
      const bool fitted = depth.states[first + u + l] == FilteredDepth::State::fitted;
      trusts_[first + u + l] = fitted ? std::min(1.0f, trust[l]) : 1.0f;
    }
  }
}

}  // namespace palpate
