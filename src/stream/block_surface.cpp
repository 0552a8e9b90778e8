// Measures radii, areas and precisions of the points of a depth frame.
#include "stream/block_surface.hpp"

#include <algorithm>
#include <cmath>

#include "field/formulas.hpp"
#include "stream/lanes.hpp"

namespace palpate {
namespace {

// Radii of blocks as surface points (docs/method.md 6.7; judgement).
constexpr float kSpacings = 2.5f;  // R in spacings
constexpr float kRows = 2.2f;      // R in the largest distance to a neighbour
constexpr float kSlope = 0.5f;     // of R over distance

// Deviation of a position that is certain, in R: at three of it, 0.47 R, a point still weighs more
// than half by Wyvill's kernel (judgement; docs/method.md 6.7).
constexpr float kCertain = 0.157f;

// Deviations of a point within R, so that R shows a layer of noise as a layer: as many as in clouds
// (docs/method.md 5.3).
constexpr float kLayer = 4;

// Half a wave of noise of correlation c, in c blocks: white noise after a blur of s pixels crosses
// its mean every sqrt(2) pi s, and c is 2 sqrt(pi) s (derived; Rice 1944).
constexpr float kHalfWave = 0.627f;

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
  measure(depth, exact_within,
          exact_within.empty() ? BlockRims::Exact::nowhere : BlockRims::Exact::within);
}

void BlockSurface::measure(const FilteredDepth& depth) {
  measure(depth, {}, BlockRims::Exact::everywhere);
}

void BlockSurface::measure(const FilteredDepth& depth, std::span<const Ball> balls,
                           BlockRims::Exact exact) {
  for (auto* column : {&radii_, &areas_, &trusts_}) column->resize(depth.size() + kLanes);
  // What tiles around a kept one have changed reaches it when it is filtered again.
  bool whole = padded_.make_room(depth, std::max(padded_.margin, BlockRims::kLargestWindow));
  each_other(depth, whole, [&](int v, int first, int count) {
    padded_.lay_out_positions(depth, v, first, count);
    start(depth, v, first, count);
  });
  limit_radii(depth);
  hidden_.find({depth, radii_}, padded_);
  rims_.find(depth, radii_, padded_, hidden_, balls, exact, whole);
  if (rims_.largest_half() > padded_.margin) {
    whole = padded_.make_room(depth, rims_.largest_half());
    each_row(depth, [&](std::size_t v) {
      padded_.lay_out_positions(depth, static_cast<int>(v), 0, depth.columns);
    });
  }
  each_other(depth, whole, [&](int v, int first, int count) { lay_out(depth, v, first, count); });
  each_other(depth, whole,
             [&](int v, int first, int count) { measure_trust(depth, v, first, count); });
  if (rims_.largest_half() > 0) rims_.weigh(depth, radii_, padded_, areas_);
}

// Radii by spacing, and areas of a surface that goes on on all sides.
void BlockSurface::start(const FilteredDepth& depth, int v, int first, int count) {
  const auto pitch = static_cast<float>(depth.pitch);
  const float whole = static_cast<float>(plane_integral(kernel_));
  const float half_wave = kHalfWave * static_cast<float>(depth.noise.correlation);
  const std::size_t begin = static_cast<std::size_t>(v) * depth.columns + first;
  for (std::size_t b = begin; b < begin + static_cast<std::size_t>(count); ++b) {
    if (!present(depth, b)) {
      radii_[b] = areas_[b] = 0;
      continue;
    }
    const float side = pitch * depth.positions[b].z();
    const float rows = std::max(side, depth.spacings[b]);
    const float area = side * rows;
    const float layer = std::min(kLayer * depth.deviations[b], half_wave * rows);
    radii_[b] = std::max({kSpacings * std::sqrt(area), kRows * rows, layer, minimum_radius_});
    areas_[b] = area / whole;
  }
}

// Two passes over the image carry a small radius to everywhere (a chamfer transform). Most blocks
// have no much smaller one beside them; they are passed over until one becomes smaller.
void BlockSurface::limit_radii(const FilteredDepth& depth) {
  fours_ = (static_cast<std::size_t>(depth.columns) + kLanes - 1) / kLanes;
  steep_.resize(fours_ * static_cast<std::size_t>(depth.rows));
  each_row(depth, [&](std::size_t v) { find_steep(depth, static_cast<int>(v)); });
  carry(depth, 1);
  carry(depth, -1);
}

// In which fours of a row may a radius be limited by a neighbour's? Blocks are at least their pitch
// apart, so most pairs need no look at where they are.
void BlockSurface::find_steep(const FilteredDepth& depth, int v) {
  const float step = kSlope * static_cast<float>(depth.pitch);
  const std::ptrdiff_t columns = depth.columns;
  std::uint8_t* const steep = &steep_[static_cast<std::size_t>(v) * fours_];
  std::fill_n(steep, fours_, 1);
  if (v == 0 || v + 1 == depth.rows) return;
  for (std::ptrdiff_t u = kLanes; u + kLanes < columns; u += kLanes) {
    const float* const at = &radii_[v * columns + u];
    const auto own = load<Floats>(at);
    const Floats room = step * load<Floats>(&padded_.z[padded_.index(static_cast<int>(u), v)]);
    Ints limited{};
    for (const std::ptrdiff_t by : {std::ptrdiff_t{-1}, std::ptrdiff_t{1}, -columns, columns}) {
      const auto other = load<Floats>(at + by);
      limited |= (own - other > room) & (other != 0);
    }
    steep[u / kLanes] = any(limited) ? 1 : 0;
  }
}

// Forwards (1) or backwards (-1).
void BlockSurface::carry(const FilteredDepth& depth, std::ptrdiff_t sign) {
  const std::ptrdiff_t columns = depth.columns;
  const float step = kSlope * static_cast<float>(depth.pitch);
  const auto limit = [&](std::ptrdiff_t b, std::ptrdiff_t by) {
    const float room = radii_[b] - radii_[by];
    if (room <= step * depth.positions[b].z() || radii_[by] == 0) return false;
    const float rise = kSlope * (depth.positions[b] - depth.positions[by]).norm();
    if (!(rise < room)) return false;
    radii_[b] = radii_[by] + rise;
    return true;
  };
  const auto steep = [&](std::ptrdiff_t u, std::ptrdiff_t v) -> std::uint8_t& {
    return steep_[static_cast<std::size_t>(v) * fours_ + static_cast<std::size_t>(u / kLanes)];
  };
  for (std::ptrdiff_t row = 0; row < depth.rows; ++row) {
    const std::ptrdiff_t v = sign > 0 ? row : depth.rows - 1 - row;
    for (std::ptrdiff_t k = 0; k < columns; ++k) {
      const std::ptrdiff_t u = sign > 0 ? k : columns - 1 - k;
      if (steep(u, v) == 0) {
        k += sign > 0 ? kLanes - 1 - u % kLanes : u % kLanes;
        continue;
      }
      const std::ptrdiff_t b = v * columns + u;
      const bool along = k > 0 && limit(b, b - sign);
      const bool across = row > 0 && limit(b, b - sign * columns);
      if (!along && !across) continue;
      steep(std::max<std::ptrdiff_t>(u - 1, 0), v) = 1;
      steep(std::min(u + 1, columns - 1), v) = 1;
      steep(u, std::max<std::ptrdiff_t>(v - 1, 0)) = 1;
      steep(u, std::min<std::ptrdiff_t>(v + 1, depth.rows - 1)) = 1;
    }
  }
}

// Puts side by side what sums over neighbours need.
void BlockSurface::lay_out(const FilteredDepth& depth, int v, int first, int count) {
  std::size_t at = padded_.index(first, v);
  std::size_t b = static_cast<std::size_t>(v) * depth.columns + first;
  const auto take = [&](const auto& radius, const auto& deviation, const auto& area, auto lanes) {
    using Lanes = decltype(lanes);
    const Lanes least = kCertain * radius;
    const Lanes spread = kDeviations * deviation;
    const Lanes sum = radius * radius / area;
    const Lanes precision = 1 / (deviation * deviation + least * least);
    const auto there = radius > 0;
    const Lanes nothing{};
    put(padded_.reaches, at, radius < spread ? spread : radius);
    put(padded_.per_r2, at, there ? 1 / (radius * radius) : nothing + PaddedBlocks::kNowhere);
    put(padded_.precisions, at, there ? precision : nothing);
    put(padded_.sums, at, there ? (1 < sum ? sum : nothing + 1) : nothing);
  };
  int u = 0;
  for (; u + kLanes <= count; u += kLanes, at += kLanes, b += kLanes) {
    take(load<Floats>(&radii_[b]), load<Floats>(&depth.deviations[b]), load<Floats>(&areas_[b]),
         Floats{});
  }
  for (; u < count; ++u, ++at, ++b) {
    take(radii_[b], depth.deviations[b], areas_[b], 0.0f);
  }
}

void BlockSurface::measure_trust(const FilteredDepth& depth, int v, int first, int count) {
  const std::size_t row = static_cast<std::size_t>(v) * depth.columns;
  const auto stride = static_cast<std::ptrdiff_t>(padded_.stride);
  const std::ptrdiff_t beside[] = {-stride - 1, -stride,    -stride + 1, -1,
                                   1,           stride - 1, stride,      stride + 1};
  for (int u = first; u < first + count; u += kLanes) {
    const float* const z = &padded_.z[padded_.index(u, v)];
    const float* const precisions = &padded_.precisions[padded_.index(u, v)];
    const auto own = load<Floats>(precisions);
    const auto reach = load<Floats>(&padded_.reaches[padded_.index(u, v)]);
    Floats same_surface{};
    Floats sum{};
    for (const std::ptrdiff_t by : beside) {
      const auto precision = load<Floats>(precisions + by);
      const Floats apart = load<Floats>(z + by) - load<Floats>(z);
      const Ints same = (precision > 0) & (apart <= reach) & (-apart <= reach);
      same_surface -= __builtin_convertvector(same, Floats);
      sum += same ? precision : Floats{};
    }
    const Floats trust = sum > 0 ? own * same_surface / sum : Floats{} + 1;
    for (int l = 0; l < std::min(kLanes, depth.columns - u); ++l) {
      const bool fitted = depth.states[row + u + l] == FilteredDepth::State::fitted;
      trusts_[row + u + l] = fitted ? std::min(1.0f, trust[l]) : 1.0f;
    }
  }
}

}  // namespace palpate
