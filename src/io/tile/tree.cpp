// Sorts the points of a chunk and makes the nodes of an octree from them.
#include "io/tile/tree.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace palpate::io::tile {
namespace {

constexpr int kSpacingLevels = 7;              // 2^7 spacings along an edge (format)
constexpr std::size_t kSide = (1U << 7U) + 2;  // small cells along an edge, with one around them
constexpr int kKeyBits = 21;                   // of each axis in a key of 64 bits

struct Key {
  std::uint64_t code;
  std::uint32_t index;
};

void append(std::vector<std::byte>& to, const std::byte* record, std::size_t size) {
  to.insert(to.end(), record, record + size);
}

}  // namespace

void Settled::add(const Branch& branch, const Layout& layout) {
  if (!branch.inner && branch.records.empty()) return;
  const auto points = static_cast<std::uint32_t>(branch.records.size() / layout.size());
  nodes.push_back({branch.cell, points, bytes.size()});
  append(bytes, branch.records.data(), branch.records.size());
}

Joiner::Joiner(const Layout& layout, int bits)
    : layout_(layout), bits_(bits), heads_(kSide * kSide * kSide) {}

// Takes a point unless one that is taken lies nearer than the root of `least` steps.
bool Joiner::take(const Numbers& numbers, int shift, std::uint64_t least) {
  std::array<std::size_t, 3> cell;
  for (std::size_t k = 0; k < 3; ++k) {
    cell[k] = (numbers[k] >> shift & ((1U << kSpacingLevels) - 1)) + 1;
  }
  const auto place = [&](std::size_t x, std::size_t y, std::size_t z) {
    return (x * kSide + y) * kSide + z;
  };
  const auto near = [&](std::uint32_t head) {
    for (; head != 0; head = taken_[head].next) {
      std::uint64_t square = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t step = std::int64_t{numbers[k]} - std::int64_t{taken_[head].numbers[k]};
        square += static_cast<std::uint64_t>(step * step);
      }
      if (square < least) return true;
    }
    return false;
  };
  const std::size_t own = place(cell[0], cell[1], cell[2]);
  if (near(heads_[own])) return false;
  for (std::size_t x = cell[0] - 1; x <= cell[0] + 1; ++x) {
    for (std::size_t y = cell[1] - 1; y <= cell[1] + 1; ++y) {
      const std::size_t middle = place(x, y, cell[2]);
      for (std::size_t i = middle - 1; i <= middle + 1; ++i) {
        if (heads_[i] != 0 && i != own && near(heads_[i])) return false;
      }
    }
  }
  taken_.push_back({numbers, heads_[own]});
  heads_[own] = static_cast<std::uint32_t>(taken_.size() - 1);
  return true;
}

Branch Joiner::join(const Cell& cell, std::vector<Branch> children, Settled& settled) {
  const int shift = bits_ - kSpacingLevels - cell.level;  // of numbers, to those of small cells
  const int exponent = std::max(shift, 0);  // a spacing below a step keeps twins apart
  const std::uint64_t least = std::uint64_t{1} << (2 * exponent);
  const std::size_t size = layout_.size();
  taken_.assign(1, {});  // the first stands for none
  Branch parent{cell, false, {}};
  for (Branch& child : children) {
    std::vector<std::byte>& records = child.records;
    std::size_t left = 0;
    for (std::size_t at = 0; at < records.size(); at += size) {
      if (take(numbers_of(records.data() + at), exponent, least)) {
        append(parent.records, records.data() + at, size);
      } else {
        std::memmove(records.data() + left, records.data() + at, size);
        left += size;
      }
    }
    records.resize(left);
    parent.inner = parent.inner || child.inner || left > 0;
    settled.add(child, layout_);
  }
  for (const Taken& each : taken_) {
    std::size_t place = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      place = place * kSide + (each.numbers[k] >> exponent & ((1U << kSpacingLevels) - 1)) + 1;
    }
    heads_[place] = 0;
  }
  return parent;
}

std::vector<std::byte> sort_records(std::span<const std::byte> records, const Layout& layout,
                                    const Cell& cell, int bits) {
  const std::size_t size = layout.size();
  const int below = bits - cell.level;
  const int rest = std::max(below - kKeyBits, 0);  // bits of each axis that no key holds
  std::vector<Key> keys(records.size() / size);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    Numbers numbers = numbers_of(records.data() + i * size);
    for (std::uint32_t& n : numbers) n = (n & ((1U << below) - 1)) >> rest;
    keys[i] = {morton(numbers), static_cast<std::uint32_t>(i)};
  }
  const auto low = [&](const std::byte* record) {
    Numbers numbers = numbers_of(record);
    for (std::uint32_t& n : numbers) n &= (1U << rest) - 1;
    return morton(numbers);
  };
  std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
    if (a.code != b.code) return a.code < b.code;
    const std::byte* first = records.data() + a.index * size;
    const std::byte* second = records.data() + b.index * size;
    if (rest > 0) {
      if (const auto x = low(first), y = low(second); x != y) return x < y;
    }
    return std::memcmp(first, second, size) < 0;
  });
  std::vector<std::byte> sorted;
  sorted.reserve(records.size());
  for (const Key& key : keys) append(sorted, records.data() + key.index * size, size);
  return sorted;
}

namespace {

// Where the first of the records behind `child` begins.
std::size_t end_of(const Cell& child, std::span<const std::byte> records, std::size_t begin,
                   std::size_t size, int bits) {
  std::size_t count = (records.size() - begin) / size;
  while (count > 0) {
    const std::size_t half = count / 2;
    const std::byte* middle = records.data() + begin + half * size;
    if (cell_of(numbers_of(middle), child.level, bits) <= child) {
      begin += (half + 1) * size;
      count -= half + 1;
    } else {
      count = half;
    }
  }
  return begin;
}

}  // namespace

Branch Joiner::grow(const Cell& cell, std::span<const std::byte> records, std::size_t most,
                    Settled& settled) {
  const std::size_t size = layout_.size();
  if (records.size() / size <= most || cell.level == bits_) {
    return {cell, false, {records.begin(), records.end()}};
  }
  std::vector<Branch> children;
  std::size_t begin = 0;
  for (unsigned i = 0; i < 8; ++i) {
    const Cell child = cell.child(i);
    const std::size_t end = end_of(child, records, begin, size, bits_);
    if (end > begin) {
      children.push_back(grow(child, records.subspan(begin, end - begin), most, settled));
    }
    begin = end;
  }
  return join(cell, std::move(children), settled);
}

}  // namespace palpate::io::tile
