#pragma once

#include <cstdint>
#include <vector>

#include "prepare/sheets.hpp"

namespace palpate {

/// 1 for each point that is much farther from others than most and on no sheet with them.
/// `typical`: the median spacing, m. In sorted order.
[[nodiscard]] std::vector<std::uint8_t> find_strays(const SheetInput& input, double typical);

}  // namespace palpate
