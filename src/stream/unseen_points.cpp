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
  motions_.clear();
  motions_.reserve(blocks);
  order_.reserve(blocks);
  sorting_.reserve(blocks);
}

void UnseenPoints::add(std::span<const PointMotion> motions) {
  for (PointMotion motion : motions) {
    if (motion.entry.kind != EntryKind::removed && ++held_ > most_) PointMoves::remove(motion);
    if (!PointMoves::is_gone(motion)) motions_.push_back(motion);
  }
}

void UnseenPoints::write(PointWriter& writer, PointWriter::Extremes& extremes,
                         std::vector<Entry>& entries) {
  using Eigen::Array3f;
  Array3f lower = Array3f::Constant(std::numeric_limits<float>::max());
  Array3f upper = -lower;
  for (const PointMotion& motion : motions_) {
    lower = lower.min(motion.from.position.array());
    upper = upper.max(motion.from.position.array());
  }
  const float extent = std::max((upper - lower).maxCoeff(), std::numeric_limits<float>::min());
  order_.clear();
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const Array3f share = (motions_[i].from.position.array() - lower) / extent;
    const Eigen::Array<std::uint32_t, 3, 1> cell = (kUnseenSteps * share).cast<std::uint32_t>();
    const std::uint64_t code = detail::morton_key(cell.x(), cell.y(), cell.z());
    order_.push_back(code << detail::kIndexBits | i);
  }
  sorting_.resize(order_.size());
  detail::sort_records(order_, sorting_, detail::kKeyBits);
  std::size_t at = writer.append(motions_.size());
  entries.resize(writer.count());
  for (const detail::Record record : order_) {
    PointMotion& motion = motions_[record & detail::kIndexMask];
    motion.code = kUnseenCode | static_cast<std::uint32_t>(record >> detail::kIndexBits);
    writer.write(at, motion, extremes);
    writer.add_edge(at, motion.edge);
    writer.add_eye(motion);
    entries[at++] = motion.entry;
  }
}

}  // namespace palpate
