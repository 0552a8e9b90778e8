// Measures the blocks of a depth frame and reads off what they show.
#include "stream/frame_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

// The least cosine of the angle between a ray and a normal that can be trusted (judgement).
constexpr float kGrazing = 0.3f;

template <class T, class Of>
Floats gather(const std::array<std::size_t, kLanes>& at, const T& column, const Of& of) {
  return Floats{of(column[at[0]]), of(column[at[1]]), of(column[at[2]]), of(column[at[3]])};
}

Vectors gather(const std::array<std::size_t, kLanes>& at,
               const std::vector<Eigen::Vector3f>& column) {
  return {gather(at, column, [](const auto& v) { return v.x(); }),
          gather(at, column, [](const auto& v) { return v.y(); }),
          gather(at, column, [](const auto& v) { return v.z(); })};
}

Floats gather(const std::array<std::size_t, kLanes>& at, const std::vector<float>& column) {
  return gather(at, column, [](float value) { return value; });
}

}  // namespace

float SeenPoint::advance_from(const Eigen::Vector3f& from) const {
  const Eigen::Vector3f offset = state.position - from;
  return std::max(std::abs(offset.dot(state.normal)), kGrazing * offset.norm());
}

SeenPoint SeenFour::lane(int l) const {
  SeenPoint point;
  point.index = index + static_cast<std::uint32_t>(l);
  if (!(radius[l] > 0)) return point;
  point.state = {.position = position.lane(l),
                 .normal = normal.lane(l),
                 .radius = radius[l],
                 .confidence = confidence[l]};
  point.area = area[l];
  point.trust = trust[l];
  point.variance = variance[l];
  point.state.weight = point.weight(point.state.radius);
  point.edge = static_cast<std::uint32_t>(edges[l]);
  return point;
}

void FrameBlocks::look(const FilteredDepth& depth, std::span<const Ball> reach, bool everywhere) {
  if (order_.columns != depth.columns || order_.rows != depth.rows) {
    order_ = make_block_order(depth.columns, depth.rows);
    resized_ = true;
  }
  note_kept(depth.kept);
  if (everywhere) {
    surface_.measure(depth);
  } else {
    const Eigen::Isometry3d T_sensor_world = depth.T_world_sensor.inverse();
    local_reach_.clear();
    for (const Ball& ball : reach) {
      local_reach_.push_back({T_sensor_world * ball.center, ball.radius});
    }
    surface_.measure(depth, local_reach_);
  }
  note_hidden();
  edges_.look(depth, surface_);
}

bool FrameBlocks::put(const FilteredDepth& depth, const Eigen::Vector3d& origin, bool streams) {
  const Eigen::Isometry3d& T_world_sensor = depth.T_world_sensor;
  const bool resized = std::exchange(resized_, false);
  const bool moved = resized || T_world_sensor.matrix() != T_world_sensor_.matrix();
  if (moved) std::ranges::fill(kept_, 0);  // a frame may have been lost in between
  depth_ = &depth;
  streams_ = streams;
  T_world_sensor_ = T_world_sensor;
  turn_ = T_world_sensor.linear().cast<float>();
  shift_ = (T_world_sensor.translation() - origin).cast<float>();
  return moved;
}

void FrameBlocks::note_kept(const KeptTiles& kept) {
  kept_.assign(order_.size() == 0 ? 0 : order_.codes.back() / kInTile + 1, 0);
  for (int row = 0; row < order_.rows; row += KeptTiles::kSide) {
    for (int column = 0; column < order_.columns; column += KeptTiles::kSide) {
      kept_[curve_code(column, row) / kInTile] = kept.at(column, row) ? 1 : 0;
    }
  }
}

void FrameBlocks::note_hidden() {
  hide_.assign(order_.size() / kLanes + 1, 0);
  for (const std::uint32_t block : surface_.hidden().blocks()) {
    hide_[order_.indices[block] / kLanes] = 1;
  }
}

SeenPoint FrameBlocks::behind(std::uint32_t index) const {
  const HiddenPlanes::Point& point = surface_.hidden().at(order_.blocks[index]);
  SeenPoint seen;
  seen.index = index;
  if (!(point.radius > 0)) return seen;
  seen.state = {.position = turn_ * point.position + shift_,
                .normal = turn_ * point.normal,
                .radius = point.radius,
                .confidence = point.confidence};
  seen.area = point.area;
  // Whatever is seen is more certain.
  seen.variance = point.radius * point.radius;
  seen.state.weight = seen.weight(point.radius);
  return seen;
}

SeenFour FrameBlocks::four_at(std::size_t index) const {
  std::array<std::size_t, kLanes> at;
  SeenFour four;
  for (std::size_t k = 0; k < kLanes; ++k) {
    at[k] = order_.blocks[std::min(index + k, order_.size() - 1)];
    four.edges[static_cast<int>(k)] = static_cast<std::int32_t>(edges_.number(at[k]));
  }
  four.position = turn_ * gather(at, depth_->positions) + all_lanes(shift_);
  four.normal = turn_ * gather(at, depth_->normals);
  four.radius = gather(at, surface_.radii());
  four.confidence = gather(at, depth_->confidences);
  four.area = gather(at, surface_.areas());
  four.trust = streams_ ? gather(at, surface_.trusts()) : Floats{} + 1.0f;
  const Floats deviation = gather(at, depth_->deviations);
  four.variance = deviation * deviation;
  four.index = static_cast<std::uint32_t>(index);
  return four;
}

float FrameBlocks::vouching(std::size_t index) const {
  const std::size_t block = order_.blocks[index];
  float count = 0;
  float all = 0;
  visit_beside(order_.columns, order_.rows, block, [&](std::size_t other) {
    ++all;
    const float apart = depth_->positions[other].z() - depth_->positions[block].z();
    const bool same = surface_.radius(other) > 0 && std::abs(apart) < surface_.radius(block);
    count += same ? 1.0f : 0.0f;
  });
  return all > 0 ? count / all : 1;
}

std::uint32_t FrameBlocks::index_of(const Eigen::Vector3f& position, const Pinhole& p) const {
  const Eigen::Array2f focal = Eigen::Array2d(p.fx, p.fy).cast<float>() / 2;
  const Eigen::Array2f center = Eigen::Array2d(p.cx - 0.5, p.cy - 0.5).cast<float>() / 2;
  const Eigen::Array2f size(static_cast<float>(order_.columns), static_cast<float>(order_.rows));
  const Eigen::Matrix3f back = turn_.transpose();
  const Eigen::Vector3f local = back * (position - shift_);
  const Eigen::Array2f block = local.head<2>().array() * (1 / local.z()) * focal + center + 0.5f;
  if (!(local.z() > 0 && (block >= 0).all() && (block < size).all())) return kNone;
  const Eigen::Array2i at = block.cast<int>();
  return order_.indices[static_cast<std::size_t>(at.y() * order_.columns + at.x())];
}

SurfacePoints::EdgePlane FrameBlocks::edge_of(const SeenPoint& seen) const {
  if (seen.edge == EdgeFinder::kNone) return {};
  const SurfacePoints::EdgePlane& edge = edges_.plane(seen.edge);
  return {turn_ * edge.normal, edge.height, edge.share};
}

}  // namespace palpate
