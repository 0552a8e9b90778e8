#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate::simd {

/// Sums over neighbourhoods, for many query points at a time against one list of candidates.
///
/// Lanes are queries and candidates come one by one in the order given, so that a sum's rounding
/// depends neither on the number of lanes nor on the instruction set. Plain pointers alone cross
/// this border: code for newer processors must not leak into what older ones run.

/// Arrays of queries hold a multiple of this many entries.
inline constexpr std::size_t kQueryStep = 8;

/// Coordinates, m.
struct Coordinates {
  const float* x;
  const float* y;
  const float* z;
  std::size_t count;
};

/// Rows of moments(): number of neighbours, then the sums of d, dd' (upper triangle, row by row)
/// over them, d = neighbour - query.
inline constexpr std::size_t kMoments = 10;

struct JoinFunctions {
  /// rows[k][query]: the moments of all candidates within squared_radii[query].
  void (*moments)(const Coordinates& queries, const float* squared_radii,
                  const Coordinates& candidates, float* const* rows);

  /// rows[k][query]: the four (eight) smallest squared distances, rising; infinity where there are
  /// fewer candidates. nearest8_apart passes over candidates at distance zero.
  void (*nearest4)(const Coordinates& queries, const Coordinates& candidates, float* const* rows);
  void (*nearest8_apart)(const Coordinates& queries, const Coordinates& candidates,
                         float* const* rows);

  /// sums[query] = sum of w(|d| / R) * values[candidate], R = 1 / sqrt(inverse[candidate]).
  void (*wyvill_sums)(const Coordinates& queries, const Coordinates& candidates,
                      const float* inverse, const float* values, float* sums);
  void (*wendland_sums)(const Coordinates& queries, const Coordinates& candidates,
                        const float* inverse, const float* values, float* sums);

  /// The same for two columns of values, with the R of the query: 1 / sqrt(inverse[query]), passing
  /// over candidates at distance zero.
  void (*wyvill_means)(const Coordinates& queries, const float* inverse,
                       const Coordinates& candidates, const float* const* values,
                       float* const* sums);
};

extern const JoinFunctions kJoinsBaseline;
extern const JoinFunctions kJoinsV3;

/// The faster of the two that this processor runs.
[[nodiscard]] const JoinFunctions& best_joins() noexcept;

}  // namespace palpate::simd
