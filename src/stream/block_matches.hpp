// Declares which of the points that were shown last a block shows again.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "stream/frame_blocks.hpp"
#include "stream/lanes.hpp"
#include "stream/moving_points.hpp"
#include "stream/shown_points.hpp"

namespace palpate {

/// Lists which entries are at which block.
class BlockEntries {
 public:
  /// Entries by their indices on the curve, equal indices in rising order of entries.
  void sort(std::span<const Entry> entries, std::size_t blocks);

  /// Numbers of the entries at an index of the curve.
  [[nodiscard]] std::span<const std::uint32_t> at(std::size_t index) const {
    return std::span(sorted_).subspan(begin_[index], begin_[index + 1] - begin_[index]);
  }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no entry

  /// The first of four entries that follow one another, one at each of four indices; else kNone.
  [[nodiscard]] std::uint32_t four_at(std::size_t index) const {
    const std::uint32_t begin = begin_[index];
    if (begin_[index + kLanes] != begin + kLanes) return kNone;
    const Ints one = load<Ints>(&begin_[index + 1]) - load<Ints>(&begin_[index]) == 1;
    const auto entries = load<Ints>(&sorted_[begin]);
    return all(one & (entries == entries[0] + Ints{0, 1, 2, 3})) ? sorted_[begin] : kNone;
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> sorted_;
};

/// Matches what the blocks of a frame show with the points that were shown last. Does not decide
/// what becomes of them.
class BlockMatches {
 public:
  /// Both have to last as long.
  BlockMatches(ShownPoints& shown, const FrameBlocks& blocks) : shown_(shown), blocks_(blocks) {}

  /// Finds which points are at which block. `moved`: blocks see elsewhere than before, through that
  /// pinhole. `duration`: of the next snapshot, s.
  void begin(bool moved, const Pinhole& pinhole, double duration);

  /// Finds it for the points that will be shown from now on, in case the camera stands still.
  void end(std::span<const Entry> entries);

  /// What was shown is forgotten.
  void forget() { listed_ = false; }

  /// The old points at an index of the curve.
  [[nodiscard]] std::span<const std::uint32_t> at(std::size_t index) const {
    return by_block_.at(index);
  }

  /// The first of four old points that follow one another, each alone at its index; else
  /// BlockEntries::kNone.
  [[nodiscard]] std::uint32_t four_at(std::size_t index) const { return by_block_.four_at(index); }

  /// An old point, and how it was.
  struct Partner {
    std::uint32_t i;
    PointState before;
  };

  /// Which of the old points at its block is seen again: the nearest within R, or within what noise
  /// explains; or what has come along the ray as fast as things move.
  [[nodiscard]] std::optional<Partner> partner_of(const SeenPoint& seen) const;

 private:
  void follow_camera(const Pinhole& pinhole);
  [[nodiscard]] bool may_move(const SeenPoint& seen, std::uint32_t i,
                              const PointState& before) const;
  [[nodiscard]] bool came_aside(const SeenPoint& seen) const;

  ShownPoints& shown_;
  const FrameBlocks& blocks_;
  BlockEntries by_block_;
  bool listed_ = false;  // does `by_block_` list the points that are shown?
  bool moved_ = false;
  float duration_ = 0;
};

}  // namespace palpate
