// Decides whether a point goes to where its block shows a surface now, and how far.
#include <algorithm>
#include <cmath>

#include "scene/policies/morph.hpp"

namespace palpate {
namespace {

// Share of the blocks around one that have to show what moves: most (judgement).
constexpr float kVouchToMove = 0.6f;

constexpr float kBeside = 0.5f;  // R by which depths of one surface differ from block to block

constexpr float kLeastShare = 0.01f;  // of an edge; with less it is none

// A surface that moves faster than this along its normal is taken for another one, m/s
// (judgement; docs/method.md 7.3).
constexpr float kFastest = 1;

// The least cosine of the angle between a ray and a normal that can be trusted (judgement).
constexpr float kGrazing = 0.3f;

// A surface that jumps goes on by so much faster than before, m/s: 0.3 N a millisecond at 500 N/m.
constexpr float kSudden = 0.6f;

}  // namespace

/// How far a surface has gone along its normal when it was at `from`, m: what a block shows of it
/// goes farther along the ray.
float Morph::advance_of(const Point& seen, const Eigen::Vector3f& from) {
  const Eigen::Vector3f way = seen.state.position - from;
  return std::max(std::abs(way.dot(seen.state.normal)), kGrazing * way.norm());
}

/// Does a surface that faced along `normal` face elsewhere now? One whose normal is not known does
/// not.
bool Morph::turns(const Point& seen, const Eigen::Vector3f& normal) {
  return !normal.isZero(0) &&
         seen.state.normal.dot(normal) < kTurns * seen.state.normal.squaredNorm();
}

/// Has it turned so within a frame? One that goes on to is believed after a while.
bool Morph::turns_away(const Point& seen, std::uint32_t i, const PointState& before) const {
  return turns(seen, before.normal) && moment_.stamp - entries_[i].confirmed < options_.silence;
}

/// Is the old point elsewhere than what is seen now, within noise, and hardly a block around it
/// shows that, too? Such a frame does not tell where the surface is.
bool Morph::stays(const FilteredDepth& depth, const Point& seen, const PointState& before) const {
  return (before.position - seen.state.position).norm() > seen.state.radius &&
         beside(depth, order_.blocks[seen.place]) < kVouchToMove;
}

/// Has what was there come along the ray to what is seen now?
bool Morph::may_move(const FilteredDepth& depth, const Point& seen, std::uint32_t i,
                     const PointState& before) const {
  if (entries_[i].kind != EntryKind::live || moved_) return false;
  const float fastest = kFastest + std::min(speed_of(i), kSudden);
  return !turns(seen, before.normal) &&
         advance_of(seen, before.position) <= fastest * static_cast<float>(moment_.duration) &&
         beside(depth, order_.blocks[seen.place]) >= kVouchToMove && !came_aside(seen);
}

/// The share of blocks around one that show the same surface: what flies between two has few.
float Morph::beside(const FilteredDepth& depth, std::size_t block) const {
  float count = 0;
  float all = 0;
  visit_beside(order_.columns, order_.rows, block, [&](std::size_t other) {
    ++all;
    const float apart = depth.positions[other].z() - depth.positions[block].z();
    const bool same = surface_.radius(other) > 0 && std::abs(apart) < surface_.radius(block);
    count += same ? 1.0f : 0.0f;
  });
  return all > 0 ? count / all : 1;
}

/// Was what a block shows now beside it before? Then the rim of something moved, or is noisy.
bool Morph::came_aside(const Point& seen) const {
  bool found = false;
  visit_beside(order_.columns, order_.rows, order_.blocks[seen.place], [&](std::size_t other) {
    for (const std::uint32_t i : by_block_.at(place_of_block_[other])) {
      const float apart = depth_of(old_point(i).position) - depth_of(seen.state.position);
      const bool same = std::abs(apart) < kBeside * seen.state.radius;
      found = found || (same && entries_[i].kind == EntryKind::live);
    }
  });
  return found;
}

/// How fast a point has moved along its normal while the last snapshot lasted, m/s.
float Morph::speed_of(std::uint32_t i) const {
  if (!(last_moment_.duration > 0)) return 0;
  const Eigen::Vector3f way = last_->end_positions[i] - last_->grid.points()[i];
  return std::abs(way.dot(last_->end_normals[i])) / static_cast<float>(last_moment_.duration);
}

/// How far along its normal a point goes to where it is seen, as a share: a block that is much less
/// sure than what is known, as beside what begins to hide it or when it is seen again, counts for
/// as much less while the two agree (the gain of a Kalman filter).
float Morph::gain_of(const Point& seen, float known, float advance) const {
  const float both = known + seen.variance;
  const bool unsure = seen.variance > kUnsure * known;
  return unsure && advance * advance < kAgree * kAgree * both ? known / both : 1;
}

/// Lets the old point go to the new one.
Way Morph::follow(const Point& seen, std::uint32_t i, const PointState& from) const {
  PointState to = seen.state;
  const float known = entries_[i].variance * doubt_;
  const float apart = (to.position - from.position).dot(to.normal);
  const float gain = gain_of(seen, known, apart);
  to.position -= (1 - gain) * apart * to.normal;
  const Eigen::Vector3f way = to.position - from.position;
  if (way.squaredNorm() > to.radius * to.radius) {
    const float most = (speed_of(i) + kSudden) * static_cast<float>(moment_.duration);
    const float advance = std::max(advance_of(seen, from.position), to.radius);
    to.position = from.position + std::min(1.0f, std::max(most, to.radius) / advance) * way;
  }
  to.radius = from.radius + kShare * (to.radius - from.radius);
  to.confidence = from.confidence + kShare * (to.confidence - from.confidence);
  to.weight = seen.weight(to.radius);
  if (to.normal.isZero(0)) to.normal = from.normal;
  to.presence = std::min(1.0f, from.presence + comes_);
  return {from, to, edge_of(seen, i), Entry{moment_.stamp, gain < 1 ? known : seen.variance}};
}

/// The edge of an old point that is seen again. Most have none.
EdgeWay Morph::edge_of(const Point& seen, std::uint32_t i) const {
  if (seen.edge == kNone && last_->edges.of_point[i] == SurfacePoints::Edges::kNone) return {};
  const SurfacePoints::EdgePlane was = old_edge(i);
  SurfacePoints::EdgePlane edge = new_edge(seen);
  const float share = was.share + kShare * (edge.share - was.share);
  if (edge.share == 0) edge = was;
  edge.share = std::abs(share) > kLeastShare ? share : 0;
  return {was, edge};
}

}  // namespace palpate
