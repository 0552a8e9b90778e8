#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "scene/policies/lanes.hpp"

namespace palpate {

/// The blocks of an image along a Z-order curve, on which neighbours in the image stay near each
/// other: points in this order are indexed without sorting.
struct BlockOrder {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint32_t> blocks;  ///< in the curve's order; row by row numbers
  std::vector<std::uint32_t> codes;   ///< where on the curve, rising; two bits a level

  [[nodiscard]] std::size_t size() const { return blocks.size(); }
};

/// @param columns, rows: 0 to 32768.
[[nodiscard]] BlockOrder make_block_order(int columns, int rows);

/// Calls visit(block) for those around a block, row by row.
template <class Visit>
void visit_beside(int columns, int rows, std::size_t block, const Visit& visit) {
  const int u = static_cast<int>(block) % columns;
  const int v = static_cast<int>(block) / columns;
  for (int y = std::max(0, v - 1); y <= std::min(rows - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(columns - 1, u + 1); ++x) {
      const auto other = static_cast<std::size_t>(y * columns + x);
      if (other != block) visit(other);
    }
  }
}

/// What a point of a morphing surface is.
enum class EntryKind : std::uint8_t {
  live,     ///< the surface that a block shows, or showed last
  hidden,   ///< by what the block shows
  going,    ///< has been seen through, and is trusted less and less
  leaving,  ///< nobody feels it any more: its weight goes over one frame
  outside,  ///< has left the image, which a moving camera looks elsewhere now
};

/// What is remembered of a point besides what the field needs of it.
struct Entry {
  double confirmed = 0;          ///< stamp of the last frame that showed it, or what hides it, s
  float variance = 0;            ///< of where it is along its ray, m^2
  std::uint32_t place : 29 = 0;  ///< of its block on the curve
  EntryKind kind : 3 = EntryKind::live;
};

/// Lists which entries are at which block.
class BlockEntries {
 public:
  /// Entries by their places on the curve, equal places in rising order of entries.
  void sort(std::span<const Entry> entries, std::size_t blocks);

  /// Numbers of the entries at a place of the curve.
  [[nodiscard]] std::span<const std::uint32_t> at(std::size_t place) const {
    return std::span(sorted_).subspan(begin_[place], begin_[place + 1] - begin_[place]);
  }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// The first of four entries that follow one another, one at each of four places; else kNone.
  [[nodiscard]] std::uint32_t four_at(std::size_t place) const {
    const std::uint32_t begin = begin_[place];
    if (begin_[place + kLanes] != begin + kLanes) return kNone;
    const Ints one = load<Ints>(&begin_[place + 1]) - load<Ints>(&begin_[place]) == 1;
    const auto entries = load<Ints>(&sorted_[begin]);
    return all(one & (entries == entries[0] + Ints{0, 1, 2, 3})) ? sorted_[begin] : kNone;
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> sorted_;
};

}  // namespace palpate
