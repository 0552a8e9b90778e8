#pragma once

// Chooses the window that fits a block best. In an anonymous namespace: see windows.inl.

#include "depth/simd/aside.inl"

namespace palpate::simd {
namespace {

// Reach of a window whose slopes give the foreshortening well enough, blocks; 1: the plain ones do.
inline int first_reach(const FitInput& in, const Chunk& c, int i) {
  constexpr double kSlopeError = 0.15;  // of the tangent (judgement)
  constexpr int kLargestReach = 8;      // blocks (judgement)
  const double step = in.step_x < in.step_y ? in.step_x : in.step_y;
  const double wanted = kSlopeError * c.rho[i] * step;
  int half = 1;
  while (half < kLargestReach) {
    const Extent& e = kExtents.of[half];
    const double per_n = e.per_n * e.per_n;
    const double variance = shared_over(in.shared, 1, per_n) * c.variance[i];
    if (variance * per_n * e.per_mu <= wanted * wanted) break;
    ++half;
  }
  return half;
}

// Where noise drowns the slopes over 3x3 blocks, wider windows replace them if they are flat.
inline void widen_slopes(const FitInput& in, int row, Chunk& c) {
  int half[kChunk];
  int four[kLanes];
  int filled = 0;
  for (int i = 0; i < c.count; ++i) {
    half[i] = first_reach(in, c, i);
    if (half[i] > 1) four[filled++] = i;
    if (filled == 0 || (filled < kLanes && i + 1 < c.count)) continue;
    for (int l = filled; l < kLanes; ++l) four[l] = four[0];
    const Fits f = fit_four(in, row, c, four, half, half);
    for (int l = 0; l < filled; ++l) {
      if (!f.affine[l]) continue;
      c.slope_x[four[l]] = static_cast<float>(f.cu[l] / (kRhoUnits * in.step_x));
      c.slope_y[four[l]] = static_cast<float>(f.cv[l] / (kRhoUnits * in.step_y));
    }
    filled = 0;
  }
}

// Grows windows around four blocks for as long as one surface explains them. A torn window that no
// plane explains shows nothing: growing goes on over it, but does not take it.
inline void grow_four(const FitInput& in, int row, const int four[kLanes], Chunk& c) {
  Mask growing = ~Mask{};
  Mask good{};    // is the last size taken?
  Mask affine{};  // of the largest windows that are explained
  Mask edge{};
  Mask size = Mask{} - 1;  // their number
  for (int k = 0; k < kSizes && any(growing); ++k) {
    bool as_large = true;
    for (int l = 0; l < kLanes; ++l) as_large &= as_below(c, k, four[l]);
    if (as_large) {
      size -= good;
      continue;
    }
    const Fits f = fit_four(in, row, c, four, c.half_u[k], c.half_v[k]);
    const Mask vague = f.full & f.torn & ~f.affine;
    const Mask ends = growing & ~vague & ~(f.affine | bends(f, k));
    edge |= ends & ~f.quadratic;
    growing &= ~ends;
    good = growing & ~vague;
    affine = good ? f.affine : affine;
    size = good ? Mask{} + k : size;
  }
  for (int l = 0; l < kLanes; ++l) {
    const int i = four[l];
    c.edge[i] = edge[l] != 0;
    if (size[l] < 0) continue;
    c.kind[i] = affine[l] ? kAffine : kQuadratic;
    c.best_u[i] = c.half_u[size[l]][i];
    c.best_v[i] = c.half_v[size[l]][i];
  }
}

// Writes a fit of a block. A surface more than four deviations away from what was measured gives
// its slopes, but not its position.
inline void write(const FitInput& in, const Chunk& c, int i, const Surface& s, int lane,
                  const FitRow& out) {
  const int column = c.columns[i];
  const double off = s.rho[lane] - c.rho[i];
  const bool away = !(off * off <= 16 * c.variance[i]);
  const double rho = away ? c.rho[i] : s.rho[lane];
  const double variance = away ? c.variance[i] : s.var_rho[lane];
  const double per_x = 1 / (kRhoUnits * in.step_x);
  const double per_y = 1 / (kRhoUnits * in.step_y);
  const double var_x = s.var_u[lane] * per_x * per_x;
  const double var_y = s.var_v[lane] * per_y * per_y;
  out.rho[column] = static_cast<float>(rho / kRhoUnits);
  out.variance[column] = static_cast<float>(variance / (kRhoUnits * kRhoUnits));
  out.slope_x[column] = static_cast<float>(s.slope_u[lane] * per_x);
  out.slope_y[column] = static_cast<float>(s.slope_v[lane] * per_y);
  out.slope_variance[column] = static_cast<float>(var_x > var_y ? var_x : var_y);
  out.confidences[column] = 1;
  if (away) out.flat[column] = kBentWindow;
}

// Calls take(four, filled) for the listed blocks, four at a time; the last ones repeat.
template <class Take>
[[gnu::always_inline]] inline void by_fours(const int* blocks, int count, const Take& take) {
  for (int first = 0; first < count; first += kLanes) {
    int four[kLanes];
    for (int l = 0; l < kLanes; ++l) four[l] = blocks[first + l < count ? first + l : first];
    take(four, count - first < kLanes ? count - first : kLanes);
  }
}

// Most blocks lie on a plane as far as their largest windows reach. Lists those that do not.
inline int fit_planes(const FitInput& in, int row, Chunk& c, const FitRow& out, int* rest) {
  int all[kChunk];
  for (int i = 0; i < c.count; ++i) all[i] = i;
  int count = 0;
  by_fours(all, c.count, [&](const int* four, int filled) {
    constexpr int kLast = kSizes - 1;  // the largest size
    const Fits f = fit_four(in, row, c, four, c.half_u[kLast], c.half_v[kLast]);
    const Surface s = affine_at(f, Doubles{}, Doubles{});
    for (int l = 0; l < filled; ++l) {
      if (!f.affine[l]) {
        rest[count++] = four[l];
        continue;
      }
      c.kind[four[l]] = kAffine;
      write(in, c, four[l], s, l, out);
    }
  });
  return count;
}

inline void finish(const FitInput& in, int row, const Chunk& c, const int* blocks, int count,
                   const FitRow& out) {
  by_fours(blocks, count, [&](const int* four, int filled) {
    Doubles du;
    Doubles dv;
    Mask affine;
    for (int l = 0; l < kLanes; ++l) {
      du[l] = -c.shift_u[four[l]];
      dv[l] = -c.shift_v[four[l]];
      affine[l] = c.kind[four[l]] == kAffine ? -1 : 0;
    }
    const Fits f = fit_four(in, row, c, four, c.best_u, c.best_v);
    const Surface s = surface_at(f, affine, du, dv);
    for (int l = 0; l < filled; ++l) write(in, c, four[l], s, l, out);
  });
}

void fit_blocks(const FitInput& in, int row, const std::int32_t* columns, int count,
                const FitRow& out) noexcept {
  for (int first = 0; first < count; first += kChunk) {
    Chunk c;
    c.count = count - first < kChunk ? count - first : kChunk;
    c.columns = columns + first;
    start(in, row, out, c);
    widen_slopes(in, row, c);
    size_windows(in, row, c);
    for (int i = 0; i < c.count; ++i) out.flat[c.columns[i]] = kStraight;
    int rest[kChunk];
    const int more = fit_planes(in, row, c, out, rest);
    by_fours(rest, more, [&](const int* four, int) { grow_four(in, row, four, c); });
    int fitted = 0;
    for (int k = 0; k < more; ++k) {
      const int i = rest[k];
      if (c.edge[i]) try_aside(in, row, c, i);
      out.flat[c.columns[i]] = c.kind[i] == kAffine ? kPlaneNearBy : kBentWindow;
      if (c.kind[i] != kNone) rest[fitted++] = i;
    }
    finish(in, row, c, rest, fitted, out);
    constexpr int kLargest = kSizes - 1;  // size
    for (int i = 0; i < c.count; ++i) {
      const int reach_u = c.edge[i] ? c.half_u[kLargest][i] : 0;
      out.reach_u[c.columns[i]] = static_cast<std::uint8_t>(reach_u);
      out.reach_v[c.columns[i]] = static_cast<std::uint8_t>(c.half_v[kLargest][i]);
    }
  }
}

// Running sums over blocks.
constexpr double kWeights[5] = {0, 12, 6, 4, 3};  // 12 / pixels; 0: filled

void build_table(const WindowTable& table, const BlockRows& filled) noexcept {
  const std::ptrdiff_t line = std::ptrdiff_t{kWindowSums} * (table.columns + 1);
  std::memset(table.sums, 0, sizeof(double) * static_cast<std::size_t>(line));
  for (int r = 0; r < table.rows; ++r) {
    const std::ptrdiff_t from = (table.first_row + r) * filled.stride + table.first_column;
    const double* above = table.sums + r * line + kWindowSums;
    double* to = table.sums + (r + 1) * line;
    const double v = r - table.rows / 2;
    Doubles low{};
    Doubles high{};
    std::memset(to, 0, sizeof(double) * kWindowSums);
    to += kWindowSums;
    for (int c = 0; c < table.columns; ++c, above += kWindowSums, to += kWindowSums) {
      const float rho = filled.rho[from + c];
      const double q = static_cast<double>(static_cast<int>(rho * float(kRhoUnits) + .5F));
      const double u = c - table.columns / 2;
      const double count = rho > 0 ? kBlock + kWeights[filled.counts[from + c]] : 0;
      low += q * Doubles{1, u, v, u * u};
      high += Doubles{q * (u * v), q * (v * v), q * q, count};
      const Doubles low_here = load(above) + low;
      const Doubles high_here = load(above + 4) + high;
      std::memcpy(to, &low_here, sizeof low_here);
      std::memcpy(to + 4, &high_here, sizeof high_here);
    }
  }
}

}  // namespace
}  // namespace palpate::simd
