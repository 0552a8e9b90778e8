// Makes the surface of a depth frame out of the one before it.
#include "stream/morph.hpp"

#include <algorithm>

#include "geometry/parallel.hpp"

namespace palpate {
namespace {

// Blocks that are settled together: as many as a processor's cache holds, for so many threads.
constexpr std::size_t kBlocks = 512;
constexpr std::size_t kPieces = 16;  // judgement

// Single precision resolves a micrometre as far from the points' origin as this, m.
constexpr double kFarFromOrigin = 16;

}  // namespace

Morph::Morph(const MorphOptions& options)
    : options_(options),
      blocks_(options.kernel, options.minimum_radius),
      matches_(shown_, blocks_),
      moves_(options_, shown_, blocks_),
      fates_(shown_, blocks_, matches_, moves_),
      pieces_(kPieces) {}

void Morph::look(const MorphInput& input) {
  blocks_.look(input.depth, input.reach, input.everywhere);
  // An image without a block cannot hold old points.
  if (blocks_.order().size() == 0) forget();
}

void Morph::fill_still(const MorphInput& input, const FrameTiming& moment,
                       const std::shared_ptr<SurfacePoints>& points) {
  forget();
  fill(input, moment, points, true);
}

void Morph::fill(const MorphInput& input, const FrameTiming& moment,
                 const std::shared_ptr<SurfacePoints>& points) {
  fill(input, moment, points, false);
}

void Morph::fill(const MorphInput& input, const FrameTiming& moment,
                 const std::shared_ptr<SurfacePoints>& points, bool still) {
  moves_.begin(moment, input.last, still);
  start(input, moment, *points);
  PointWriter::Extremes extremes;
  const std::size_t size = blocks_.order().size();
  for (std::size_t index = 0; index < size; index += kPieces * kBlocks) {
    const std::size_t end = std::min(size, index + kPieces * kBlocks);
    const std::span pieces = std::span(pieces_).first((end - index + kBlocks - 1) / kBlocks);
    settle(index, end, pieces);
    for (const Piece& piece : pieces) extremes.add(piece.extremes);
  }
  unseen_.write(writer_, extremes, entries_);
  detail::parallel_pair([&] { writer_.end(extremes); },
                        [&] {
                          if (!still) matches_.end(entries_);
                        });
  shown_.replace(points, moment, entries_);
}

void Morph::start(const MorphInput& input, const FrameTiming& moment, SurfacePoints& points) {
  const Eigen::Vector3d camera = input.depth.T_world_sensor.translation();
  const bool far = (camera - origin_).norm() > kFarFromOrigin;
  if (!shown_.any() || far) origin_ = camera;
  streams_ = shown_.any() && (streams_ || moment.stamp != shown_.stamp());
  shown_.begin(moment, origin_);
  const bool moved = blocks_.put(input.depth, origin_, streams_) && shown_.any();
  matches_.begin(moved, input.pinhole, moment.duration);
  points.origin = origin_;
  points.kernel = options_.kernel;
  if (!points.eye) points.eye.emplace();
  points.eye->position = camera;
  points.eye->remembered.clear();
  const std::size_t old = shown_.entries().size();
  const std::size_t blocks = blocks_.order().size();
  unseen_.begin(blocks);
  writer_.begin(points, std::max(old + old / 16, blocks / 2));
}

/// Divides the blocks of the curve among threads, decides what becomes of their points, counts
/// these, so that each piece gets the index of its first point, and writes them.
void Morph::settle(std::size_t begin, std::size_t end, std::span<Piece> pieces) {
  detail::parallel_each(pieces.size(), 1, [&](std::size_t k) {
    const std::size_t first = begin + k * kBlocks;
    fates_.settle(first, std::min(end, first + kBlocks), pieces[k].settled);
  });
  for (Piece& piece : pieces) {
    piece.first = writer_.append(piece.settled.count());
    unseen_.add(piece.settled.unseen);
  }
  entries_.resize(writer_.count());
  detail::parallel_each(pieces.size(), 1, [&](std::size_t k) { write(pieces[k]); });
  for (const Piece& piece : pieces) {
    for (const auto& [at, edge] : piece.edges) writer_.add_edge(at, edge);
  }
}

void Morph::write(Piece& piece) {
  piece.extremes = {};
  piece.edges.clear();
  std::size_t at = piece.first;
  auto four = piece.settled.advancing.begin();
  const auto write_fours_before = [&](std::size_t index) {
    for (; four != piece.settled.advancing.end() && four->index < index; ++four, at += kLanes) {
      write(at, *four, piece);
    }
  };
  for (const PointMotion& motion : piece.settled.shown) {
    write_fours_before(motion.entry.index);
    write(at++, motion, piece);
  }
  write_fours_before(blocks_.order().size());
}

void Morph::write(std::size_t at, const PointMotion& motion, Piece& piece) {
  writer_.write(at, motion, piece.extremes);
  if (motion.edge.start.share != 0 || motion.edge.end.share != 0)
    piece.edges.push_back({at, motion.edge});
  entries_[at] = motion.entry;
}

void Morph::write(std::size_t at, const PointMotion4& motions, Piece& piece) {
  writer_.write(at, &blocks_.order().codes[motions.index], motions.from, motions.to,
                piece.extremes);
  for (std::uint32_t k = 0; k < kLanes; ++k) {
    entries_[at + k] = moves_.seen_entry(motions.variance[k]);
    entries_[at + k].index = motions.index + k;
  }
}

}  // namespace palpate
