#pragma once

// Which window fits a block best. In an anonymous namespace: see windows.inl.

#include "depth/simd/chunk.inl"

namespace palpate::simd {
namespace {

// Looks up four windows, one around each of the blocks `four`.
[[gnu::always_inline]] inline Fits fit_four(const FitInput& in, int row, const Chunk& c,
                                            const int four[kLanes], const int* sizes_u,
                                            const int* sizes_v) {
  int half_u[kLanes];
  int half_v[kLanes];
  int columns[kLanes];
  int rows[kLanes];
  Moments s;
  for (int l = 0; l < kLanes; ++l) {
    const int i = four[l];
    half_u[l] = sizes_u[i];
    half_v[l] = sizes_v[i];
    columns[l] = c.columns[i] + c.shift_u[i] - in.table.first_column;
    rows[l] = row + c.shift_v[i] - in.table.first_row;
    s.set(in.table, l, columns[l], rows[l], half_u[l], half_v[l]);
  }
  s.u = lanes(columns) - double(in.table.columns / 2);
  s.v = lanes(rows) - double(in.table.rows / 2);
  return fit(in, shape(half_u, half_v), s);
}

// How far a window has to reach for slopes that tell the foreshortening; 1: the plain ones do.
inline int first_reach(const FitInput& in, const Chunk& c, int i) {
  constexpr double kSlopeError = 0.15;  // of the tangent
  constexpr int kLargestReach = 8;
  const double step = in.step_x < in.step_y ? in.step_x : in.step_y;
  const double wanted = kSlopeError * c.rho[i] * step;
  int half = 1;
  while (half < kLargestReach) {
    const Extent& e = kExtents.of[half];
    const double per_n = e.per_n * e.per_n;
    const double shared = in.shared / (1 + kUnseenShare[1] * (in.shared - 1) * per_n);
    if (shared * c.variance[i] * per_n * e.per_mu <= wanted * wanted) break;
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

inline bool same_size(const Chunk& c, int k, const int four[kLanes]) {
  if (k == 0) return false;
  int differ = 0;
  for (int l = 0; l < kLanes; ++l) {
    differ |= c.half_u[k][four[l]] ^ c.half_u[k - 1][four[l]];
    differ |= c.half_v[k][four[l]] ^ c.half_v[k - 1][four[l]];
  }
  return differ == 0;
}

// Grows windows around four blocks for as long as one surface explains them.
inline void grow_four(const FitInput& in, int row, const int four[kLanes], Chunk& c) {
  Mask growing = ~Mask{};
  Mask affine{};  // of the largest windows that are explained
  Mask edge{};
  Mask curved{};           // by what the first window shows that is too large
  Mask size = Mask{} - 1;  // their number
  for (int k = 0; k < kSizes && any(growing); ++k) {
    if (same_size(c, k, four)) {
      size -= growing;
      continue;
    }
    const Fits f = fit_four(in, row, c, four, c.half_u[k], c.half_v[k]);
    const Mask good = f.affine | (k < kBentSizes ? f.quadratic : Mask{});
    edge |= growing & ~good & ~f.quadratic;
    curved |= growing & ~good & f.quadratic & f.bent;
    growing &= good;
    affine = growing ? f.affine : affine;
    size -= growing;
  }
  for (int l = 0; l < kLanes; ++l) {
    const int i = four[l];
    c.edge[i] = edge[l] != 0;
    if (size[l] < 0) continue;
    // Where the next window is clearly bent, this one seemed flat by luck.
    const bool flat = affine[l] && !(curved[l] && size[l] < kBentSizes);
    c.kind[i] = flat ? kAffine : kQuadratic;
    c.best_u[i] = c.half_u[size[l]][i];
    c.best_v[i] = c.half_v[size[l]][i];
  }
}

inline void grow_centred(const FitInput& in, int row, Chunk& c) {
  for (int first = 0; first < c.count; first += kLanes) {
    int four[kLanes];
    for (int l = 0; l < kLanes; ++l) four[l] = first + l < c.count ? first + l : first;
    grow_four(in, row, four, c);
  }
}

// Four windows beside a block: along the axes, or between them.
struct Directions {
  int u[kLanes];
  int v[kLanes];
};
constexpr Directions kStraight{{1, 0, -1, 0}, {0, 1, 0, -1}};
constexpr Directions kDiagonal{{1, -1, -1, 1}, {1, 1, -1, -1}};

// One block on its search beside edges, and the best window found for it.
struct Search {
  int i;
  int column, row;  // in the table
  Doubles lever_u2, lever_v2;
  double score;
  Kind kind;
  int shift_u, shift_v, half_u, half_v;
};

inline int shift_of(int half, bool whole) {
  return whole ? half : (half + 1) / 2;
}

// The best scores that windows beside the block may reach: those of the largest ones, were the
// surface flat.
inline Doubles promise(const FitInput& in, const Chunk& c, const Search& s, const Directions& to,
                       bool whole) {
  constexpr int kLast = kSizes - 1;
  const Shape g = shape(c.half_u[kLast][s.i], c.half_v[kLast][s.i]);
  const Doubles du = lanes(to.u, shift_of(c.half_u[kLast][s.i], whole));
  const Doubles dv = lanes(to.v, shift_of(c.half_v[kLast][s.i], whole));
  return shared_over(in.shared, 1, g.per_n) * c.variance[s.i] * g.per_n *
         (1.0 + (du * du + s.lever_u2) * g.per_mu + (dv * dv + s.lever_v2) * g.per_mv);
}

// Lets windows grow in four directions, each until the first that is not explained or cannot win.
inline void follow(const FitInput& in, const Chunk& c, const Directions& to, bool whole,
                   Search& search) {
  Mask growing = promise(in, c, search, to, whole) < search.score;
  Doubles best = same(search.score);
  Mask affine{};
  Mask size = Mask{} - 1;
  for (int k = 0; k < kSizes && any(growing); ++k) {
    const int half_u = c.half_u[k][search.i];
    const int half_v = c.half_v[k][search.i];
    if (k > 0 && half_u == c.half_u[k - 1][search.i] && half_v == c.half_v[k - 1][search.i]) {
      continue;
    }
    const int shift_u = shift_of(half_u, whole);
    const int shift_v = shift_of(half_v, whole);
    Moments s;
    for (int l = 0; l < kLanes; ++l) {
      s.set(in.table, l, search.column + to.u[l] * shift_u, search.row + to.v[l] * shift_v, half_u,
            half_v);
    }
    const Doubles du = lanes(to.u, -shift_u);
    const Doubles dv = lanes(to.v, -shift_v);
    s.u = double(search.column - in.table.columns / 2) - du;
    s.v = double(search.row - in.table.rows / 2) - dv;
    const Fits f = fit(in, shape(half_u, half_v), s);
    growing &= f.affine | (k < kBentSizes ? f.quadratic : Mask{});
    const Doubles off = surface_at(f, f.affine, du, dv).rho - c.rho[search.i];
    const Doubles scores = score(f, f.affine, du, dv, search.lever_u2, search.lever_v2);
    const Mask better = growing & (off * off <= 4 * c.variance[search.i]) & (scores < best);
    best = better ? scores : best;
    affine = better ? f.affine : affine;
    size = better ? Mask{} + k : size;
  }
  for (int l = 0; l < kLanes; ++l) {
    if (size[l] < 0 || !(best[l] < search.score)) continue;
    search.score = best[l];
    search.kind = affine[l] ? kAffine : kQuadratic;
    search.half_u = c.half_u[size[l]][search.i];
    search.half_v = c.half_v[size[l]][search.i];
    search.shift_u = to.u[l] * shift_of(search.half_u, whole);
    search.shift_v = to.v[l] * shift_of(search.half_v, whole);
  }
}

inline double centred_score(const FitInput& in, int row, const Chunk& c, const Search& search) {
  const int four[kLanes] = {search.i, search.i, search.i, search.i};
  const Mask affine = c.kind[search.i] == kAffine ? ~Mask{} : Mask{};
  const Fits f = fit_four(in, row, c, four, c.best_u, c.best_v);
  return score(f, affine, Doubles{}, Doubles{}, search.lever_u2, search.lever_v2)[0];
}

// Near an edge windows beside the block see more of its surface than those around it.
inline void try_aside(const FitInput& in, int row, Chunk& c, int i) {
  const auto lever_u = static_cast<double>(c.lever_u[i]);
  const auto lever_v = static_cast<double>(c.lever_v[i]);
  Search search{.i = i,
                .column = c.columns[i] - in.table.first_column,
                .row = row - in.table.first_row,
                .lever_u2 = same(lever_u * lever_u),
                .lever_v2 = same(lever_v * lever_v),
                .score = HUGE_VAL,
                .kind = c.kind[i],
                .shift_u = 0,
                .shift_v = 0,
                .half_u = c.best_u[i],
                .half_v = c.best_v[i]};
  if (c.kind[i] != kNone) search.score = centred_score(in, row, c, search);
  follow(in, c, kStraight, false, search);
  follow(in, c, kDiagonal, false, search);
  follow(in, c, kStraight, true, search);
  follow(in, c, kDiagonal, true, search);
  c.kind[i] = search.kind;
  c.shift_u[i] = search.shift_u;
  c.shift_v[i] = search.shift_v;
  c.best_u[i] = search.half_u;
  c.best_v[i] = search.half_v;
}

// The guard: a surface more than four deviations away from what was measured keeps its slopes, but
// not its place.
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
  if (away) out.flat[column] = 0;
}

inline void finish(const FitInput& in, int row, const Chunk& c, const FitRow& out) {
  for (int first = 0; first < c.count;) {
    int four[kLanes];
    int filled = 0;
    for (; first < c.count && filled < kLanes; ++first) {
      if (c.kind[first] != kNone) four[filled++] = first;
    }
    if (filled == 0) return;
    for (int l = filled; l < kLanes; ++l) four[l] = four[0];
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
  }
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
    grow_centred(in, row, c);
    for (int i = 0; i < c.count; ++i) {
      if (c.edge[i]) try_aside(in, row, c, i);
      out.at_edge[c.columns[i]] = c.edge[i];
      out.flat[c.columns[i]] = c.kind[i] == kAffine;
    }
    finish(in, row, c, out);
  }
}

}  // namespace
}  // namespace palpate::simd
