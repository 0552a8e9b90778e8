#pragma once

#include "depth/blocks.hpp"
#include "depth/fit_region.hpp"

namespace palpate::depth {

inline constexpr int kLongestGap = 3;  ///< blocks

/// Blocks of `range` without small holes: `filled` gets a copy in which gaps in rows, then in
/// columns, of up to kLongestGap blocks between two ends that may be one surface are bridged.
/// Filled blocks have a count of 0. One hole would otherwise cost all windows around it.
void fill_gaps(const Blocks& blocks, const NoiseModel& noise, const BlockRange& range,
               Blocks& filled);

}  // namespace palpate::depth
