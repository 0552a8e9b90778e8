#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/pinhole.hpp"
#include "scene/policies/block_order.hpp"
#include "scene/policies/lanes.hpp"

namespace palpate {

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
