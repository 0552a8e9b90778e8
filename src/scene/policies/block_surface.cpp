#include "scene/policies/block_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
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
constexpr std::size_t kRowsAtATime = 8;
constexpr float kNowhere = 1e30f;  // 1 / R^2, 1/m^2

// Of R, the deviation of a place that is sure: three of it are where a point weighs half, 0.47 R.
constexpr float kSure = 0.157f;

// Density-normalised weights of a surface that goes on on all sides sum to this times R^2 over the
// area of a point (algorithm.md section 4).
float whole_sum(Kernel kernel) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return static_cast<float>(kernel == Kernel::wyvill ? kTurn * 4 / 27 : kTurn / 14);
}

constexpr int kLanes = 4;  // blocks side by side
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::int32_t Ints __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

template <class Vector, class T>
Vector load(const T* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

Floats weight(Kernel kernel, const Floats& q) {
  if (kernel == Kernel::wendland) {
    Floats w{};
    for (int l = 0; l < kLanes; ++l) w[l] = float(wendland(double(q[l])).w);
    return w;
  }
  const Floats s = 1 - q;
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
  measure(depth, exact_within, exact_within.empty() ? Exact::nowhere : Exact::within);
}

void BlockSurface::measure(const FilteredDepth& depth) {
  measure(depth, {}, Exact::everywhere);
}

void BlockSurface::measure(const FilteredDepth& depth, std::span<const Ball> balls, Exact exact) {
  start(depth);
  limit_growth(depth);
  list_rims(depth, balls, exact);
  lay_out(depth);
  detail::parallel_ranges(static_cast<std::size_t>(depth.rows), kRowsAtATime,
                          [&](std::size_t v, std::size_t end) {
                            for (; v < end; ++v) trust_row(depth, v);
                          });
  if (largest_half_ == 0) return;
  weigh_rims(depth);
}

// Radii by spacing, and areas of a surface that goes on on all sides.
void BlockSurface::start(const FilteredDepth& depth) {
  const std::size_t count = depth.size();
  for (auto* column : {&radii_, &areas_, &trusts_}) column->resize(count);
  halves_.assign(count + kLanes, 0);
  largest_half_ = 0;
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

void BlockSurface::list_rims(const FilteredDepth& depth, std::span<const Ball> balls, Exact exact) {
  if (exact == Exact::nowhere) return;
  mark_rims(depth);
  for (std::size_t b = 0; b < depth.size(); ++b) {
    if (radii_[b] == 0) continue;
    const auto inside = [&](const Ball& ball) {
      return (depth.positions[b].cast<double>() - ball.center).squaredNorm() <=
             ball.radius * ball.radius;
    };
    if (exact == Exact::within && std::none_of(balls.begin(), balls.end(), inside)) continue;
    const int half = half_window(depth, b);
    if (!near_rim(depth, b, half)) continue;
    halves_[b] = half;
    largest_half_ = std::max(largest_half_, half);
  }
}

// Puts side by side what sums over neighbours need.
void BlockSurface::lay_out(const FilteredDepth& depth) {
  const int margin = std::max({margin_, largest_half_, kLanes});
  const auto stride = static_cast<std::size_t>(depth.columns + 2 * margin);
  const std::size_t size = stride * static_cast<std::size_t>(depth.rows + 2 * margin) + kLanes;
  if (margin != margin_ || stride != stride_ || size != x_.size()) {
    margin_ = margin;
    stride_ = stride;
    for (auto* column : {&x_, &y_, &z_, &reaches_, &precisions_, &sums_}) column->assign(size, 0);
    per_r2_.assign(size, kNowhere);
    ones_.assign(size, 1);
  }
  std::size_t b = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (std::size_t at = place(0, v); at < place(depth.columns, v); ++at, ++b) {
      const float radius = radii_[b];
      const float deviation = depth.deviations[b];
      const float sure = kSure * radius;
      const bool there = radius > 0;
      x_[at] = depth.positions[b].x();
      y_[at] = depth.positions[b].y();
      z_[at] = depth.positions[b].z();
      reaches_[at] = std::max(radius, kDeviations * deviation);
      per_r2_[at] = there ? 1 / (radius * radius) : kNowhere;
      precisions_[at] = there ? 1 / (deviation * deviation + sure * sure) : 0;
      sums_[at] = there ? std::max(1.0f, radius * radius / areas_[b]) : 0;
    }
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
      const bool fitted = depth.states[first + u + l] == BlockState::fitted;
      trusts_[first + u + l] = fitted ? std::min(1.0f, trust[l]) : 1.0f;
    }
  }
}

// Calls take(block, place, sum) for each block whose sum over what is around it is wanted: of
// weights times what stands in `factors`.
template <class Take>
void BlockSurface::sum_around(const FilteredDepth& depth, const float* factors, const Take& take) {
  const auto sum = [&](std::size_t at, const Ints& halves, int half) {
    const auto x = load<Floats>(&x_[at]);
    const auto y = load<Floats>(&y_[at]);
    const auto z = load<Floats>(&z_[at]);
    Floats total{};
    for (int dv = -half; dv <= half; ++dv) {
      for (int du = -half; du <= half; ++du) {
        const std::size_t from = at + dv * static_cast<std::ptrdiff_t>(stride_) + du;
        const Floats dx = load<Floats>(&x_[from]) - x;
        const Floats dy = load<Floats>(&y_[from]) - y;
        const Floats dz = load<Floats>(&z_[from]) - z;
        const Floats q = (dx * dx + dy * dy + dz * dz) * load<Floats>(&per_r2_[from]);
        const Floats w = weight(kernel_, q) * load<Floats>(factors + from);
        const Ints inside = (q < 1) & (halves >= std::max(std::abs(du), std::abs(dv)));
        total += inside ? w : Floats{};
      }
    }
    return total;
  };
  const auto row = [&](int v) {
    for (int u = 0; u < depth.columns; u += kLanes) {
      const std::size_t first = static_cast<std::size_t>(v) * depth.columns + u;
      const auto halves = load<Ints>(&halves_[first]);
      const int half = std::max({halves[0], halves[1], halves[2], halves[3]});
      if (half == 0) continue;
      const Floats sums = sum(place(u, v), halves, half);
      for (int l = 0; l < std::min(kLanes, depth.columns - u); ++l) {
        if (halves[l] > 0) take(first + l, place(u + l, v), sums[l]);
      }
    }
  };
  detail::parallel_ranges(static_cast<std::size_t>(depth.rows), kRowsAtATime,
                          [&](std::size_t v, std::size_t end) {
                            for (; v < end; ++v) row(static_cast<int>(v));
                          });
}

// a_i = 1 / max(S_i, 0.8 Sbar_i).
void BlockSurface::weigh_rims(const FilteredDepth& depth) {
  sum_around(depth, ones_.data(), [&](std::size_t, std::size_t at, float sum) { sums_[at] = sum; });
  sum_around(depth, sums_.data(), [&](std::size_t block, std::size_t at, float around) {
    const float sum = std::max(sums_[at], kShareOfAround * around / sums_[at]);
    areas_[block] = radii_[block] * radii_[block] / sum;
  });
}

}  // namespace palpate
