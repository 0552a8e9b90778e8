#pragma once

#include <cstdint>

// The sums over a patch's points that every field is made of: the only code that is compiled once
// for each level of the instruction set. Plain pointers and numbers alone cross this border.

namespace palpate::simd {

constexpr int kLanes = 4;       // doubles in 256 bits: points summed side by side on every level
constexpr int kMaxSources = 8;  // sensors and clouds of one scene; judgement, sets the size of Sums

constexpr int kLabels = 3;                       // derived: the Labels of field/segment_view.hpp
constexpr int kMaxRuns = kLabels * kMaxSources;  // derived: one run for each label of each source

// A patch in columns, relative to its centre: label by label, and within a label source by source.
// Each run of one label and source is padded to a multiple of kLanes with points of weight 0.
struct Columns {
  const double* position[3];  // m
  const double* normal[3];
  const double* weight;                   // a_i C_k
  const double* confidence;               // c_i
  const double* radius;                   // R_i, m
  const double* inverse_r2;               // 1 / R_i^2
  double uniform_radius;                  // R of all points, m; 0: they differ
  const double* edge_normal[3];           // of the plane beyond an edge
  const double* edge_height;              // of the point above it, m
  const double* edge_share;               // 0-1; below 0: in a crease
  bool edges;                             // does any point lie beside an edge?
  double* slope;                          // scratch: a_i C_k g_i / R_i^2 of the last call of `all`
  std::uint32_t* near;                    // scratch: the groups of kLanes points that reach there
  std::uint32_t run_begin[kMaxRuns + 1];  // run of a label l and source s: l * sources + s
  int sources;
  int labels;  // so many, from the first on; the others have no points

  std::uint32_t end() const { return run_begin[labels * sources]; }
};

// q_i = p_i - x, w_i with its weight, v_i = c_i w_i.
struct Moments {
  double v;      // sum v_i
  double vq[3];  // sum v_i q_i
  double vn[3];  // sum v_i n_i
  double vnq;    // sum v_i n_i . q_i
};

// The same of one source's points, as far as its own height needs them.
struct SourceMoments {
  double v;
  double vn[3];
  double vnq;
};

// The sums over the points of one label.
struct LabelSums : Moments {
  SourceMoments of[kMaxSources];  // for each source
  double grad_v[3];
};

struct Sums {
  std::uint32_t near_begin[kMaxRuns + 1];  // in Columns::near, of each run
  LabelSums label[kLabels];
  double w[kMaxSources];  // sum w_i, for each source
  double grad_w[kMaxSources][3];
  double wr_of[kMaxSources];  // sum w_i R_i, for each source
  double grad_wr_of[kMaxSources][3];
  double wr;  // of all
  double grad_wr[3];
};

// Over the points beside edges, with v_i = c_i w_i |share_i|: sum v_i, and sum v_i h_i of the
// heights of x above what both planes leave.
struct EdgeSums {
  double v;
  double grad_v[3];
  double vh;
  double grad_vh[3];
};

// b_i = n_i . alpha + q_i . beta + (n_i . q_i) gamma + delta.
struct Linear {
  double alpha[3];
  double beta[3];
  double gamma;
  double delta;
};

struct Functions {
  // The weight sums alone (metaball).
  void (*weights)(const Columns&, bool wendland, const double x[3], Sums&) noexcept;
  // All sums; leaves the slopes in their scratch column.
  void (*all)(const Columns&, bool wendland, const double x[3], Sums&) noexcept;
  // sum grad v_i b_i over the groups [begin, end) of Columns::near that `all` left for the same x.
  void (*gradient)(const Columns&, std::uint32_t begin, std::uint32_t end, const double x[3],
                   const Linear&, double out[3]) noexcept;
  // For each source an upper bound of sum w_i over the ball (x, h).
  void (*bound)(const Columns&, bool wendland, const double x[3], double h,
                double out[kMaxSources]) noexcept;

  // Over the groups [begin, end) of Columns::near that `all` left for the same x.
  void (*edges)(const Columns&, std::uint32_t begin, std::uint32_t end, bool wendland,
                const double x[3], EdgeSums&) noexcept;
};

extern const Functions kSumsBaseline;
extern const Functions kSumsV3;  // x86-64-v3; the same numbers bit for bit

// The best that this processor has.
const Functions& best_sums() noexcept;

}  // namespace palpate::simd
