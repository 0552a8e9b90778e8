// Gathers and writes the points that no block shows.
#include "stream/unseen_points.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "geometry/parallel.hpp"
#include "stream/point_moves.hpp"

namespace palpate {
namespace {

// Unseen points come behind all seen ones, on a curve through space: cells of the index along
// the image's would be as deep as the scene. Codes of blocks are below it.
constexpr std::uint32_t kUnseenCode = 1u << 30;
constexpr float kUnseenSteps = 1023;  // of that curve along an axis

}  // namespace

void UnseenPoints::begin(std::size_t blocks) {
  most_ = blocks;
  held_ = 0;
  ways_.clear();
  ways_.reserve(blocks);
  order_.reserve(blocks);
  sorting_.reserve(blocks);
}

void UnseenPoints::add(std::span<const Way> ways) {
  for (Way way : ways) {
    if (way.entry.kind != EntryKind::leaving && ++held_ > most_) PointMoves::leave(way);
    if (!PointMoves::is_gone(way)) ways_.push_back(way);
  }
}

void UnseenPoints::write(PointWriter& writer, PointWriter::Extremes& extremes,
                         std::vector<Entry>& entries) {
  using Eigen::Array3f;
  Array3f lower = Array3f::Constant(std::numeric_limits<float>::max());
  Array3f upper = -lower;
  for (const Way& way : ways_) {
    lower = lower.min(way.from.position.array());
    upper = upper.max(way.from.position.array());
  }
  const float extent = std::max((upper - lower).maxCoeff(), std::numeric_limits<float>::min());
  order_.clear();
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const Array3f share = (ways_[i].from.position.array() - lower) / extent;
    const Eigen::Array<std::uint32_t, 3, 1> cell = (kUnseenSteps * share).cast<std::uint32_t>();
    const std::uint64_t code = detail::morton_key(cell.x(), cell.y(), cell.z());
    order_.push_back(code << detail::kPlaceBits | i);
  }
  sorting_.resize(order_.size());
  detail::sort_records(order_, sorting_, detail::kKeyBits);
  std::size_t at = writer.append(ways_.size());
  entries.resize(writer.count());
  for (const detail::Record record : order_) {
    Way& way = ways_[record & detail::kPlaceMask];
    way.code = kUnseenCode | static_cast<std::uint32_t>(record >> detail::kPlaceBits);
    writer.write(at, way, extremes);
    writer.add_edge(at, way.edge);
    writer.add_eye(way);
    entries[at++] = way.entry;
  }
}

}  // namespace palpate
