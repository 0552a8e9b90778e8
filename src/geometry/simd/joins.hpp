#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::simd {

/// Sums over neighbourhoods, for eight points at a time.
///
/// Lanes are the eight query points; candidates come one by one, in rising order, so that a sum's
/// rounding depends neither on the number of lanes nor on the instruction set. Plain pointers alone
/// cross this border: code for newer processors must not leak into what older ones run.

/// Query points at a time (judgement).
inline constexpr std::size_t kQueries = 8;

/// Points [begin, end).
struct Run {
  std::uint32_t begin;
  std::uint32_t end;
};

/// The points [query, query + count) and those that may be near one of them.
struct Join {
  const float* points;  ///< x, y, z of all points, m
  std::size_t query;
  std::size_t count;                ///< query points, 1 ... kQueries
  const std::uint32_t* candidates;  ///< in rising order
  std::size_t candidate_count;
};

/// Where candidates are looked for, and how far, m^2.
struct Search {
  const Run* runs;
  std::size_t run_count;
  const float* squared_reaches;  ///< of each query point
  const float* squared_own;      ///< of all points: how far they reach themselves; nullptr: nowhere
};

/// A result for each of the query points.
using Row = float[kQueries];

/// Rows of moments(): number of neighbours, then the sums of d and of dd' (upper triangle, row by
/// row) over them, d = neighbour - query.
inline constexpr std::size_t kMoments = 10;

/// Planes fitted to neighbourhoods. Eigenvalues in m^2; the normal, the eigenvector of the
/// smallest, is a unit vector, or zero where undefined.
struct Planes {
  double normal_x[kQueries];
  double normal_y[kQueries];
  double normal_z[kQueries];
  double smallest[kQueries];
  double middle[kQueries];
  double largest[kQueries];
};

/// Leaves' tight boxes side by side, how far from each its points are visited, and their points.
/// `count` is a multiple of kQueries; entries that fill it up have a lower bound of infinity.
struct Leaves {
  const float* lower[3];  ///< x, y, z, m
  const float* upper[3];
  const float* squared_reach;  ///< m^2
  const Run* points;
  std::size_t count;
};

/// A candidate that is near queries: bit l stands for the point query + l.
struct Hit {
  std::uint32_t candidate;
  std::uint32_t queries;
};

/// What each query point looks for: points beside its segment.
struct Eyes {
  Row normal[3];        ///< x, y, z, unit
  Row squared_reach;    ///< of all that is looked for, m^2
  Row least;            ///< a point off the plane: its height is above this, m, ...
  Row squared_tube;     ///< ... its distance to the side at most the root of this, m^2, ...
  float squared_slope;  ///< ... and its height over that at least the root of this
  Row squared_vote;     ///< of points of other segments, m^2; below 0: none is looked for
  std::uint32_t segment[kQueries];
  const std::uint32_t* segments;  ///< of all points
};

struct JoinFunctions {
  /// Finds the leaves whose box is within their own reach, or root of squared_radius, of the box
  /// [lower, upper], and joins their points to runs. Leaves are in rising order. `runs` has room
  /// for count + 1; the result is runs[1] ... runs[n], and n is returned.
  std::size_t (*near)(const Leaves& leaves, const float* lower, const float* upper,
                      float squared_radius, Run* runs);

  /// The points of the search's runs that a query point reaches, or that reach one themselves, in
  /// rising order; the join's own candidates do not count. `found` has room for all of the runs and
  /// one more; returns how many there are.
  std::size_t (*gather)(const Join& join, const Search& search, std::uint32_t* found);

  /// The candidates within squared_radii[l], m^2, of the point query + l, in rising order. `hits`
  /// has room for all candidates and one more; returns how many there are.
  std::size_t (*within)(const Join& join, const float* squared_radii, Hit* hits);

  /// The same for candidates off a point's plane or on other segments than it.
  std::size_t (*apart)(const Join& join, const Eyes& eyes, Hit* hits);

  /// The moments of all candidates within squared_radii[l], m^2, of the point query + l.
  void (*moments)(const Join& join, const float* squared_radii, Row* rows);

  /// Least-squares planes from moments. Finite whenever these are.
  void (*planes)(const Row* moments, Planes* planes);

  /// The four (eight) smallest squared distances, rising; infinity where there are fewer
  /// candidates. The second passes over candidates at distance zero.
  void (*nearest4)(const Join& join, Row* rows);
  void (*nearest8_apart)(const Join& join, Row* rows);

  /// The sum of w(|d| / R) * values[candidate], R = 1 / sqrt(inverse[candidate]). No values: all 1.
  void (*wyvill_sums)(const Join& join, const float* inverse, const float* values, Row* sum);
  void (*wendland_sums)(const Join& join, const float* inverse, const float* values, Row* sum);

  /// The sums of w(|d| / R) and of w(|d| / R) * values[candidate], R = 1 / sqrt(inverse[l]) of the
  /// point query + l, passing over candidates at distance zero.
  void (*wyvill_means)(const Join& join, const float* inverse, const float* values, Row* sums);
};

extern const JoinFunctions kJoinsBaseline;
extern const JoinFunctions kJoinsV3;

/// The faster of the two that this processor runs.
[[nodiscard]] const JoinFunctions& best_joins() noexcept;

}  // namespace palpate::simd
