// Sorts the points of a chunk and makes the nodes of an octree from them.
#include "extras/tile/tree.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace palpate::io::tile {
namespace {

constexpr int kSpacingLevels = 7;  // 2^7 spacings along an edge (format)

template <std::size_t Size>
void sort_as(std::span<std::byte> records) {
  using Record = std::array<std::byte, Size>;
  const std::span all(reinterpret_cast<Record*>(records.data()), records.size() / Size);
  std::sort(all.begin(), all.end(), [](const Record& a, const Record& b) {
    const Numbers first = numbers_of(a.data());
    const Numbers second = numbers_of(b.data());
    return first == second ? std::memcmp(a.data(), b.data(), Size) < 0 : before(first, second);
  });
}

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

}  // namespace

void Settled::add(const Branch& branch, const Layout& layout) {
  if (!branch.inner && branch.records.empty()) return;
  const auto points = static_cast<std::uint32_t>(branch.records.size() / layout.size());
  nodes.push_back({branch.cell, points, bytes.size()});
  append(bytes, branch.records);
}

void Tree::sort(std::span<std::byte> records) const {
  if (layout.colors) {
    layout.intensities ? sort_as<20>(records) : sort_as<18>(records);
  } else {
    layout.intensities ? sort_as<14>(records) : sort_as<12>(records);
  }
}

Branch Tree::grow(const Cell& cell, std::span<const std::byte> records, Settled& settled) const {
  const std::size_t size = layout.size();
  const std::size_t count = records.size() / size;
  if (count <= most || cell.level == bits) {
    return {cell, false, {records.begin(), records.end()}};
  }
  std::vector<Branch> children;
  std::size_t begin = 0;
  for (unsigned i = 0; i < 8; ++i) {
    std::size_t end = begin;  // of the child's records, by halving what is left
    for (std::size_t beyond = count; end < beyond;) {
      const std::size_t middle = end + (beyond - end) / 2;
      const std::byte* const record = records.data() + middle * size;
      if (child_at(numbers_of(record), cell.level, bits) <= i) {
        end = middle + 1;
      } else {
        beyond = middle;
      }
    }
    if (end > begin) {
      children.push_back(
          grow(cell.child(i), records.subspan(begin * size, (end - begin) * size), settled));
    }
    begin = end;
  }
  return join(cell, std::move(children), settled);
}

Branch Tree::join(const Cell& cell, std::vector<Branch> children, Settled& settled) const {
  const std::size_t size = layout.size();
  const int level = std::min(cell.level + kSpacingLevels, bits);  // duplicates stay apart
  std::vector<bool> taken(std::size_t{1} << (3U * kSpacingLevels));
  Branch parent{cell, false, {}};
  for (Branch& child : children) {
    std::vector<std::byte>& records = child.records;
    std::size_t left = 0;
    for (std::size_t at = 0; at < records.size(); at += size) {
      std::size_t small = 0;
      for (const std::uint32_t n : cell_of(numbers_of(records.data() + at), level, bits).at) {
        small = small << kSpacingLevels | (n & ((1U << kSpacingLevels) - 1));
      }
      if (!taken[small]) {
        append(parent.records, std::span(records).subspan(at, size));
        taken[small] = true;
      } else {
        std::memmove(records.data() + left, records.data() + at, size);
        left += size;
      }
    }
    records.resize(left);
    parent.inner = parent.inner || child.inner || left > 0;
    settled.add(child, layout);
  }
  return parent;
}

}  // namespace palpate::io::tile
