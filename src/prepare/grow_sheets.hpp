#pragma once

#include <cstdint>
#include <vector>

#include "prepare/sheets.hpp"

namespace palpate {

/// Which sheet each point lies on.
struct Growths {
  SurfacePoints::Sheets sheets;  ///< every sheet is a part of its own; no gaps yet
  std::vector<std::uint8_t>
      sure;                 ///< 1: its own fit put the point there; 0: a neighbour's, or none
  std::vector<Twin> twins;  ///< in rising order
};

/// The first half of make_sheets(). Normals of one sheet agree afterwards.
[[nodiscard]] Growths grow_sheets(const SheetInput& input, OwnSheets& own);

/// How far the points i and j may be off each other's plane when they lie on one sheet, m.
[[nodiscard]] float sheet_tolerance(const SheetInput& input, const OwnSheets& own, std::uint32_t i,
                                    std::uint32_t j);

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
