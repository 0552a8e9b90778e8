// Declares the points of a morphing surface that no block shows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stream/moving_points.hpp"
#include "stream/point_writer.hpp"

namespace palpate {

/// Gathers the points that no block shows, no more of them than there are blocks.
class UnseenPoints {
 public:
  /// Forgets those of the frame before. Allocates when an image has more blocks.
  void begin(std::size_t blocks);

  /// Points beyond the most leave.
  void add(std::span<const PointMotion> motions);

  /// Writes them behind all that blocks show.
  void write(PointWriter& writer, PointWriter::Extremes& extremes, std::vector<Entry>& entries);

 private:
  std::size_t most_ = 0;
  std::size_t held_ = 0;
  std::vector<PointMotion> motions_;
  std::vector<std::uint64_t> order_;  // their codes, and indices among them
  std::vector<std::uint64_t> sorting_;
};

}  // namespace palpate
