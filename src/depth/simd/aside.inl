#pragma once

// Up to 64 blocks of one row in the fits, and windows around and beside them. In an
// anonymous namespace: see windows.inl.

#include <cmath>

#include "depth/simd/surfaces.inl"

namespace palpate::simd {
namespace {

constexpr int kChunk = 64;  // blocks (judgement)
// Sizes of quadratic fits, up to 0.57 r_max. Terms of the fourth degree would bias larger ones
// (docs/method.md 6.3).
constexpr int kBentSizes = 4;

// Where a fit with quadratic terms serves at this size.
[[gnu::always_inline]] inline Mask bends(const Fits& f, int size) {
  return size < kBentSizes ? f.quadratic : Mask{};
}

enum Kind : int { kNone, kAffine, kQuadratic };

struct Chunk {
  int count;
  const std::int32_t* columns;  // of the image
  double rho[kChunk];           // measured, in kRhoUnits
  double variance[kChunk];      // of it
  float slope_x[kChunk];        // first guesses, as in BlockFits
  float slope_y[kChunk];
  float reach_u[kChunk];  // blocks from the middle to the border of the largest window
  float reach_v[kChunk];
  float lever_u[kChunk];  // a quarter of r_max, in blocks
  float lever_v[kChunk];
  int half_u[kSizes][kChunk];
  int half_v[kSizes][kChunk];
  // The window that serves best so far: middle relative to the block, half sizes.
  Kind kind[kChunk];
  int shift_u[kChunk];
  int shift_v[kChunk];
  int best_u[kChunk];
  int best_v[kChunk];
  bool edge[kChunk];
};

// The window's sizes from a quarter of its largest reach on.
inline void round_sizes(Chunk& c) {
  const auto half = [](float reach) {
    const int rounded = static_cast<int>(reach + .5F);
    return rounded < 1 ? 1 : rounded > kLargestWindow ? kLargestWindow : rounded;
  };
  for (int k = 0; k < kSizes; ++k) {
    for (int i = 0; i < c.count; ++i) {
      c.half_u[k][i] = half(kRatios[k] * c.reach_u[i]);
      c.half_v[k][i] = half(kRatios[k] * c.reach_v[i]);
    }
  }
}

// Are a block's windows of this size as large as those of the size below?
inline bool as_below(const Chunk& c, int size, int i) {
  return size > 0 && c.half_u[size][i] == c.half_u[size - 1][i] &&
         c.half_v[size][i] == c.half_v[size - 1][i];
}

// Sets the largest windows: by noise and wanted error, in blocks that the slopes foreshorten.
inline void size_windows(const FitInput& in, int row, Chunk& c) {
  // Half side over radius: a rectangle has a disc's second moments at sqrt(3) / 2 = .866 and its
  // area at sqrt(pi) / 2 = .886; between them (judgement; docs/method.md 6.3).
  constexpr float kSide = .88F;
  const auto y = static_cast<float>(in.y0 + row * in.step_y);
  const auto step_x = static_cast<float>(in.step_x);
  const auto step_y = static_cast<float>(in.step_y);
  const float pixel = .25F * (step_x + step_y);
  const auto n0 = static_cast<float>(in.pixel_noise[0]);
  const auto n1 = static_cast<float>(in.pixel_noise[1]);
  const auto n2 = static_cast<float>(in.pixel_noise[2]);
  const auto growth = static_cast<float>(in.growth);
  const auto per_error = static_cast<float>(1.6 / in.normal_error);
  for (int i = 0; i < c.count; ++i) {
    const int column = c.columns[i];
    const auto x = static_cast<float>(in.x0 + column * in.step_x);
    const float rho = in.blocks.rho[row * in.blocks.stride + column];
    const float z = 1 / rho;
    const float a = c.slope_x[i] * z;
    const float b = c.slope_y[i] * z;
    const float ax = 1 - a * x;
    const float by = 1 - b * y;
    const float pitch_u = step_x * std::sqrt(ax * ax + a * a * (y * y + 1));  // per z
    const float pitch_v = step_y * std::sqrt(by * by + b * b * (x * x + 1));
    const float across = ax - b * y;
    const float cosine = 1 / std::sqrt((a * a + b * b + across * across) * (x * x + y * y + 1));
    const float root = std::sqrt(cosine);
    const float delta = pixel / root;                           // per z
    const float sigma = (n2 + rho * (n1 + rho * n0)) * z;       // of z, per z
    float reach = std::sqrt(per_error * sigma * pixel * root);  // per z
    reach = reach < 6 * delta ? 6 * delta : reach;
    reach = reach > 18 * delta ? 18 * delta : reach;
    reach *= growth;
    c.reach_u[i] = kSide * reach / pitch_u;
    c.reach_v[i] = kSide * reach / pitch_v;
    c.lever_u[i] = .25F * reach / pitch_u;
    c.lever_v[i] = .25F * reach / pitch_v;
  }
  round_sizes(c);
}

inline void start(const FitInput& in, int row, const FitRow& plain, Chunk& c) {
  for (int i = 0; i < c.count; ++i) {
    const std::ptrdiff_t at = row * in.blocks.stride + c.columns[i];
    const double rho = static_cast<double>(in.blocks.rho[at]);
    const double sigma = in.noise[2] + rho * (in.noise[1] + rho * in.noise[0]);
    const double variance = kRhoUnits * kRhoUnits * sigma * sigma * 4 / in.blocks.counts[at];
    c.rho[i] = kRhoUnits * rho;
    c.variance[i] = variance > 1. / 12 ? variance : 1. / 12;
    c.slope_x[i] = plain.slope_x[c.columns[i]];
    c.slope_y[i] = plain.slope_y[c.columns[i]];
    c.kind[i] = kNone;
    c.shift_u[i] = c.shift_v[i] = c.best_u[i] = c.best_v[i] = 0;
    c.edge[i] = false;
  }
}

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

// Four windows beside a block.
struct Directions {
  int u[kLanes];
  int v[kLanes];
};
// Along the axes, and along the diagonals.
constexpr Directions kDirections[2] = {{{1, 0, -1, 0}, {0, 1, 0, -1}},
                                       {{1, -1, -1, 1}, {1, 1, -1, -1}}};

// Windows of one size beside a block, moved there by half of their reach or all of it.
struct Aside {
  int size;
  bool whole, diagonal;
  // Score of a window there that sees a plane, over the variance of the largest one's mean.
  double promise;
};
constexpr int kVariants = 4;                 // half or whole, along axes or diagonals
constexpr int kAsides = kVariants * kSizes;  // each of them in each size

// The most promising first.
struct Asides {
  Aside of[kAsides];
  constexpr Asides() : of{} {
    for (int n = 0; n < kAsides; ++n) {
      Aside aside{n / kVariants, n % 4 >= 2, n % 2 == 1, 0};
      const double share = double(kRatios[aside.size]) * double(kRatios[aside.size]);
      const double shift = (aside.whole ? 3 : 0.75) * (aside.diagonal ? 2 : 1);
      aside.promise = (1 + shift + 0.48 / share) / share;
      int at = n;
      for (; at > 0 && of[at - 1].promise > aside.promise; --at) of[at] = of[at - 1];
      of[at] = aside;
    }
  }
};
constexpr Asides kAsidesInOrder;

// One block on its search beside edges, and the best window found for it.
struct Search {
  int i;
  int column, row;  // in the table
  Doubles lever_u2, lever_v2;
  double score;
  Kind kind;
  int shift_u, shift_v, half_u, half_v;
};

// Tries four windows and takes the best of the explained ones if it wins.
inline void look(const FitInput& in, const Chunk& c, const Aside& aside, Search& search) {
  const Directions& to = kDirections[aside.diagonal ? 1 : 0];
  const int half_u = c.half_u[aside.size][search.i];
  const int half_v = c.half_v[aside.size][search.i];
  const int shift_u = aside.whole ? half_u : (half_u + 1) / 2;
  const int shift_v = aside.whole ? half_v : (half_v + 1) / 2;
  Moments s;
  for (int l = 0; l < kLanes; ++l) {
    s.set(in.table, l, search.column + to.u[l] * shift_u, search.row + to.v[l] * shift_v, half_u,
          half_v);
  }
  const Doubles du = lanes(to.u, -shift_u);
  const Doubles dv = lanes(to.v, -shift_v);
  s.u = double(search.column - in.table.columns / 2) - du;
  s.v = double(search.row - in.table.rows / 2) - dv;
  const Fits f = fit(in, shape(half_u, half_v), s, aside.size >= kBentSizes);
  const Mask good = f.affine | bends(f, aside.size);
  if (!any(good)) return;
  const Doubles scores = score(f, f.affine, du, dv, search.lever_u2, search.lever_v2);
  Mask wins = good & (scores < search.score);
  if (!any(wins)) return;
  const Doubles off = surface_at(f, f.affine, du, dv).rho - c.rho[search.i];
  wins &= off * off <= 4 * c.variance[search.i];
  if (!any(wins)) return;
  for (int l = 0; l < kLanes; ++l) {
    if (!wins[l] || !(scores[l] < search.score)) continue;
    search.score = scores[l];
    search.kind = f.affine[l] ? kAffine : kQuadratic;
    search.half_u = half_u;
    search.half_v = half_v;
    search.shift_u = to.u[l] * shift_u;
    search.shift_v = to.v[l] * shift_v;
  }
}

inline double centred_score(const FitInput& in, int row, const Chunk& c, const Search& search) {
  const int four[kLanes] = {search.i, search.i, search.i, search.i};
  const Mask affine = c.kind[search.i] == kAffine ? ~Mask{} : Mask{};
  const Fits f = fit_four(in, row, c, four, c.best_u, c.best_v);
  return score(f, affine, Doubles{}, Doubles{}, search.lever_u2, search.lever_v2)[0];
}

// Looks for a better window beside a block, the most promising first: near an edge it sees more of
// the block's surface than one around it.
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
  constexpr int kLast = kSizes - 1;  // the largest size
  const double per_n =
      kExtents.of[c.half_u[kLast][i]].per_n * kExtents.of[c.half_v[kLast][i]].per_n;
  const double mean = shared_over(in.shared, 1, per_n) * c.variance[i] * per_n;
  for (const Aside& aside : kAsidesInOrder.of) {
    if (!(aside.promise * mean < search.score)) break;
    if (!as_below(c, aside.size, i)) look(in, c, aside, search);
  }
  c.kind[i] = search.kind;
  c.shift_u[i] = search.shift_u;
  c.shift_v[i] = search.shift_v;
  c.best_u[i] = search.half_u;
  c.best_v[i] = search.half_v;
}

}  // namespace
}  // namespace palpate::simd
