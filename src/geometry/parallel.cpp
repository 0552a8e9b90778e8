// Sorts records by radix on several threads; the order does not depend on how many.
#include "geometry/parallel.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace palpate::detail {
namespace {

constexpr int kMaxDigitBits = 12;   // counts of 16 KiB: they fit the first cache (judgement)
constexpr int kPartitionBits = 12;  // alike (judgement)
// Records; fewer fit the cache whole (judgement).
constexpr std::size_t kPartitionFrom = std::size_t{1} << 18;
// Records that one thread counts (judgement).
constexpr std::size_t kSortBlock = std::size_t{1} << 16;

using Counts = std::array<std::uint32_t, std::size_t{1} << kMaxDigitBits>;

std::size_t digit(Record record, int shift, std::size_t mask) {
  return (record >> shift) & mask;
}

// Makes one stable counting pass over the digit at `shift`.
void scatter(std::span<const Record> from, std::span<Record> to, int shift, int digit_bits) {
  const std::size_t mask = (std::size_t{1} << digit_bits) - 1;
  Counts offsets;
  std::fill_n(offsets.begin(), mask + 1, 0u);
  for (const Record record : from) ++offsets[digit(record, shift, mask)];
  std::uint32_t sum = 0;
  for (std::size_t d = 0; d <= mask; ++d) {
    const std::uint32_t count = offsets[d];
    offsets[d] = sum;
    sum += count;
  }
  for (const Record record : from) to[offsets[digit(record, shift, mask)]++] = record;
}

// Least significant digit first, over key bits [shift, shift + bits).
void sort_by_digits(std::span<Record> records, std::span<Record> scratch, int shift, int bits) {
  if (records.size() < 64) {  // by insertion, which needs no memory
    const auto before = [shift](Record a, Record b) { return (a >> shift) < (b >> shift); };
    for (auto at = records.begin(); at != records.end(); ++at) {
      std::rotate(std::upper_bound(records.begin(), at, *at, before), at, at + 1);
    }
    return;
  }
  const int passes = (bits + kMaxDigitBits - 1) / kMaxDigitBits;
  for (int pass = 0; pass < passes; ++pass) {
    const int digit_bits = (bits + passes - 1 - pass) / (passes - pass);
    scatter(records, scratch, shift, digit_bits);
    std::swap(records, scratch);
    shift += digit_bits;
    bits -= digit_bits;
  }
  if (passes % 2 != 0) std::copy(records.begin(), records.end(), scratch.begin());
}

// Output position of each block's first record of each digit: by digit, then by block.
std::vector<std::uint32_t> block_offsets(std::span<const Record> records, int shift) {
  const std::size_t blocks = (records.size() + kSortBlock - 1) / kSortBlock;
  const std::size_t digits = std::size_t{1} << kPartitionBits;
  std::vector<std::uint32_t> offsets(blocks * digits, 0);
  parallel_each(blocks, 1, [&](std::size_t b) {
    const auto block =
        records.subspan(b * kSortBlock, std::min(kSortBlock, records.size() - b * kSortBlock));
    for (const Record record : block) ++offsets[b * digits + digit(record, shift, digits - 1)];
  });
  std::uint32_t sum = 0;
  for (std::size_t d = 0; d < digits; ++d) {
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint32_t count = offsets[b * digits + d];
      offsets[b * digits + d] = sum;
      sum += count;
    }
  }
  return offsets;
}

}  // namespace

void sort_records(std::span<Record> records, std::span<Record> scratch, int bits) {
  const int lowest = kIndexBits + kKeyBits - bits;
  if (records.size() < kPartitionFrom || bits <= kPartitionBits) {
    sort_by_digits(records, scratch, lowest, bits);
    return;
  }
  // Too many for the cache: first into parts by the leading bits, then each part by itself.
  const int shift = kIndexBits + kKeyBits - kPartitionBits;
  const std::size_t digits = std::size_t{1} << kPartitionBits;
  std::vector<std::uint32_t> offsets = block_offsets(records, shift);
  const std::vector<std::uint32_t> starts(offsets.begin(),
                                          offsets.begin() + static_cast<std::ptrdiff_t>(digits));
  parallel_each(offsets.size() / digits, 1, [&](std::size_t b) {
    const auto block =
        records.subspan(b * kSortBlock, std::min(kSortBlock, records.size() - b * kSortBlock));
    for (const Record record : block) {
      scratch[offsets[b * digits + digit(record, shift, digits - 1)]++] = record;
    }
  });
  parallel_each(digits, 1, [&](std::size_t d) {
    const std::size_t first = starts[d];
    const std::size_t count = (d + 1 < digits ? starts[d + 1] : records.size()) - first;
    const auto part = scratch.subspan(first, count);
    const auto out = records.subspan(first, count);
    sort_by_digits(part, out, lowest, bits - kPartitionBits);
    std::copy(part.begin(), part.end(), out.begin());
  });
}

}  // namespace palpate::detail
