#pragma once

#include <cstdint>
#include <vector>

#include "prepare/grow_sheets.hpp"

namespace palpate {

/// What a pair of points says of two sheets: should their normals keep (> 0) or change (< 0) their
/// relative sign? -1 ... 1.
struct SheetVote {
  std::uint32_t a = 0;  ///< sheets, a < b
  std::uint32_t b = 0;
  float value = 0;
};

/// Measures how far the next sheet is above and below each point; returns what sheets say of each
/// other, in the order of their numbers.
[[nodiscard]] std::vector<SheetVote> look_around(const SheetInput& input, const OwnSheets& own,
                                                 Growths& grown);

}  // namespace palpate
