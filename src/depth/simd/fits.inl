#pragma once

// Which window fits a block best. In an anonymous namespace: see windows.inl.

#include "depth/simd/chunk.inl"

namespace palpate::simd {
namespace {

// Sets one of four windows over the block `i`.
inline void put(const FitInput& in, int row, const Chunk& c, int i, int lane, int shift_u,
                int shift_v, int half_u, int half_v, Windows& w) {
  w.column[lane] = c.columns[i] - in.table.first_column + shift_u;
  w.row[lane] = row - in.table.first_row + shift_v;
  w.half_u[lane] = half_u;
  w.half_v[lane] = half_v;
}

inline bool same_size(const Chunk& c, int k, int i) {
  return k > 0 && c.half_u[k][i] == c.half_u[k - 1][i] && c.half_v[k][i] == c.half_v[k - 1][i];
}

// Takes the window of size k for block i if its surface is one that the noise explains; otherwise
// says whether an edge stopped it. Returns whether the block may go on growing.
inline bool judge(bool affine, bool quadratic, int k, int i, Chunk& c) {
  if (affine || (quadratic && k < kBentSizes)) {
    c.kind[i] = affine ? kAffine : kQuadratic;
    c.best_u[i] = c.half_u[k][i];
    c.best_v[i] = c.half_v[k][i];
    return true;
  }
  c.edge[i] = !quadratic;
  return false;
}

// Grows windows around the blocks while one surface explains them.
inline void grow_centred(const FitInput& in, int row, Chunk& c) {
  int active[kChunk];
  int count = c.count;
  for (int i = 0; i < count; ++i) active[i] = i;
  for (int k = 0; k < kSizes && count > 0; ++k) {
    int kept = 0;
    for (int first = 0; first < count;) {
      int four[kLanes];
      int filled = 0;
      for (; first < count && filled < kLanes; ++first) {
        if (same_size(c, k, active[first])) {
          active[kept++] = active[first];
        } else {
          four[filled++] = active[first];
        }
      }
      if (filled == 0) continue;
      Windows w;
      for (int l = 0; l < kLanes; ++l) {
        const int i = four[l < filled ? l : 0];
        put(in, row, c, i, l, 0, 0, c.half_u[k][i], c.half_v[k][i], w);
      }
      const Fits f = fit(in, w);
      for (int l = 0; l < filled; ++l) {
        if (judge(f.affine[l] != 0, f.quadratic[l] != 0, k, four[l], c)) active[kept++] = four[l];
      }
    }
    count = kept;
  }
}

constexpr int kDirections = 8;
constexpr int kDirectionU[kDirections] = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr int kDirectionV[kDirections] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kChains = 2 * kDirections;  // each by half a window and by a whole one

// Windows that stand aside of one block.
struct Aside {
  int shift_u[kLanes], shift_v[kLanes];
  Doubles du, dv;  // of the block from their middles
};

inline Aside aside(const int chains[kLanes], int half_u, int half_v) {
  Aside a;
  for (int l = 0; l < kLanes; ++l) {
    const int direction = chains[l] % kDirections;
    const bool whole = chains[l] >= kDirections;
    a.shift_u[l] = kDirectionU[direction] * (whole ? half_u : (half_u + 1) / 2);
    a.shift_v[l] = kDirectionV[direction] * (whole ? half_v : (half_v + 1) / 2);
    a.du[l] = -a.shift_u[l];
    a.dv[l] = -a.shift_v[l];
  }
  return a;
}

// The best window found for a block.
struct Best {
  double score;
  Kind kind;
  int shift_u, shift_v, half_u, half_v;
};

// Scores four windows of one block of which `filled` count; keeps the chains that may go on.
inline int compare_four(const FitInput& in, int row, const Chunk& c, int i, int k,
                        const int chains[kLanes], int filled, int* kept, Best& best) {
  const int half_u = c.half_u[k][i];
  const int half_v = c.half_v[k][i];
  const Aside a = aside(chains, half_u, half_v);
  Windows w;
  for (int l = 0; l < kLanes; ++l) {
    put(in, row, c, i, l, a.shift_u[l], a.shift_v[l], half_u, half_v, w);
  }
  const Fits f = fit(in, w);
  const Mask good = k < kBentSizes ? f.affine | f.quadratic : f.affine;
  const Doubles lever_u2 = same(double(c.lever_u[i]) * double(c.lever_u[i]));
  const Doubles lever_v2 = same(double(c.lever_v[i]) * double(c.lever_v[i]));
  const Doubles scores = score(f, f.affine, a.du, a.dv, lever_u2, lever_v2);
  const Doubles off = surface_at(f, f.affine, a.du, a.dv).rho - c.rho[i];
  const Mask near = off * off <= 4 * c.variance[i];
  int left = 0;
  for (int l = 0; l < filled; ++l) {
    if (!good[l]) continue;
    kept[left++] = chains[l];
    if (!near[l] || !(scores[l] < best.score)) continue;
    best = {scores[l],    f.affine[l] ? kAffine : kQuadratic, a.shift_u[l], a.shift_v[l], half_u,
            half_v};
  }
  return left;
}

inline double centred_score(const FitInput& in, int row, const Chunk& c, int i) {
  Windows w;
  for (int l = 0; l < kLanes; ++l) put(in, row, c, i, l, 0, 0, c.best_u[i], c.best_v[i], w);
  const Doubles none{};
  const Mask affine = c.kind[i] == kAffine ? ~Mask{} : Mask{};
  return score(fit(in, w), affine, none, none, same(double(c.lever_u[i]) * double(c.lever_u[i])),
               same(double(c.lever_v[i]) * double(c.lever_v[i])))[0];
}

// Near an edge windows beside the block see more of its surface than those around it.
inline void try_aside(const FitInput& in, int row, Chunk& c, int i) {
  Best best{c.kind[i] == kNone ? HUGE_VAL : centred_score(in, row, c, i),
            c.kind[i],
            0,
            0,
            c.best_u[i],
            c.best_v[i]};
  int active[kChains];
  int count = kChains;
  for (int chain = 0; chain < kChains; ++chain) active[chain] = chain;
  for (int k = 0; k < kSizes && count > 0; ++k) {
    if (same_size(c, k, i)) continue;
    int kept = 0;
    for (int first = 0; first < count; first += kLanes) {
      const int filled = count - first < kLanes ? count - first : kLanes;
      int chains[kLanes];
      for (int l = 0; l < kLanes; ++l) chains[l] = active[first + (l < filled ? l : 0)];
      kept += compare_four(in, row, c, i, k, chains, filled, active + kept, best);
    }
    count = kept;
  }
  c.kind[i] = best.kind;
  c.shift_u[i] = best.shift_u;
  c.shift_v[i] = best.shift_v;
  c.best_u[i] = best.half_u;
  c.best_v[i] = best.half_v;
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
}

inline void finish(const FitInput& in, int row, const Chunk& c, const FitRow& out) {
  for (int first = 0; first < c.count;) {
    int four[kLanes];
    int filled = 0;
    for (; first < c.count && filled < kLanes; ++first) {
      if (c.kind[first] != kNone) four[filled++] = first;
    }
    if (filled == 0) return;
    Windows w;
    Doubles du;
    Doubles dv;
    Mask affine;
    for (int l = 0; l < kLanes; ++l) {
      const int i = four[l < filled ? l : 0];
      put(in, row, c, i, l, c.shift_u[i], c.shift_v[i], c.best_u[i], c.best_v[i], w);
      du[l] = -c.shift_u[i];
      dv[l] = -c.shift_v[i];
      affine[l] = c.kind[i] == kAffine ? -1 : 0;
    }
    const Surface s = surface_at(fit(in, w), affine, du, dv);
    for (int l = 0; l < filled; ++l) write(in, c, four[l], s, l, out);
  }
}

void fit_blocks(const FitInput& in, int row, const std::int32_t* columns, int count,
                const FitRow& out) noexcept {
  for (int first = 0; first < count; first += kChunk) {
    Chunk c;
    c.count = count - first < kChunk ? count - first : kChunk;
    c.columns = columns + first;
    start(in, row, c);
    size_windows(in, row, out, c);
    grow_centred(in, row, c);
    for (int i = 0; i < c.count; ++i) {
      if (c.edge[i]) try_aside(in, row, c, i);
    }
    finish(in, row, c, out);
  }
}

}  // namespace
}  // namespace palpate::simd
