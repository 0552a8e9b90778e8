#pragma once

#include <cstdint>
#include <vector>

namespace palpate::detail {

/// A vote that the normals of patches a and b should keep (> 0) or change (< 0) their relative
/// sign; its size says how sure it is.
struct Vote {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float value = 0;
};

/// Which part each patch belongs to, and its sign in it.
struct SignedParts {
  std::vector<std::uint32_t> part;  ///< 0 ... count - 1
  std::vector<float> sign;          ///< +1 or -1
  std::uint32_t count = 0;
};

/// Merges patches along their votes: in each round the votes between the same two parts add up, and
/// each part merges with the one about which they are surest (Boruvka's spanning tree, with sums
/// for weights). The result depends on the votes' order only by the rounding of sums.
[[nodiscard]] SignedParts merge_by_votes(std::uint32_t patches, std::vector<Vote> votes);

}  // namespace palpate::detail
