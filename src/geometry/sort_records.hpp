#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

/// A Morton key and the place of its point in the input, in one word: sorting words sorts by key,
/// and by place among equal keys.
using Record = std::uint64_t;

inline constexpr int kPlaceBits = 31;
inline constexpr int kKeyBits = 33;  ///< eleven levels of three bits
inline constexpr std::uint64_t kPlaceMask = (std::uint64_t{1} << kPlaceBits) - 1;

/// Sorts records by the upper `bits` of their kKeyBits key; equal keys keep their order. `scratch`
/// is as long as `records`. Runs on several threads when there are many records; the result does
/// not depend on their number.
void sort_records(std::span<Record> records, std::span<Record> scratch, int bits);

}  // namespace palpate::detail
