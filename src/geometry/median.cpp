#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

constexpr std::size_t kMany = std::size_t{1} << 17;
constexpr std::size_t kDigits = std::size_t{1} << 16;

// Integers in the order of the numbers.
std::uint32_t rank_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

float value_of(std::uint32_t rank) {
  return std::bit_cast<float>((rank & 0x80000000u) != 0 ? rank ^ 0x80000000u : ~rank);
}

// The digit in which entry `place` falls; `place` becomes its place within that digit.
std::uint32_t digit_at(const std::vector<std::uint32_t>& counts, std::size_t& place) {
  std::uint32_t digit = 0;
  for (; place >= counts[digit]; ++digit) place -= counts[digit];
  return digit;
}

// By counting upper, then lower halves of ranks: no copy, and memory is read in order.
float select(std::span<const float> values, std::size_t place) {
  std::vector<std::uint32_t> counts(kDigits, 0);
  for (const float value : values) ++counts[rank_of(value) >> 16];
  const std::uint32_t upper = digit_at(counts, place);
  std::fill(counts.begin(), counts.end(), 0u);
  for (const float value : values) {
    const std::uint32_t rank = rank_of(value);
    if (rank >> 16 == upper) ++counts[rank & (kDigits - 1)];
  }
  return value_of(upper << 16 | digit_at(counts, place));
}

}  // namespace

double median(std::span<const float> values) {
  if (values.empty()) return 0;
  const std::size_t middle = values.size() / 2;
  if (values.size() >= kMany) return static_cast<double>(select(values, middle));
  std::vector<float> sorted(values.begin(), values.end());
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(middle);
  std::nth_element(sorted.begin(), at, sorted.end());
  return static_cast<double>(*at);
}

}  // namespace palpate
