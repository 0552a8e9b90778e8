#include "scene/policies/morph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t kAhead = 32;  // blocks

// What has faded so far is gone.
constexpr float kGone = 1e-4f;

// Of what a frame says of a point's radius and confidence, this share is taken over.
constexpr float kShare = 0.25f;

// Single precision resolves a micrometre as far from the points' origin as this, m.
constexpr double kFarFromOrigin = 16;

Eigen::Vector3f mix(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float u) {
  return a + u * (b - a);
}

Eigen::Vector3f mix_normals(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float u) {
  const Eigen::Vector3f mixed = mix(a, b, u);
  const float length = mixed.norm();
  return length > 1e-6f ? Eigen::Vector3f(mixed / length) : a;
}

}  // namespace

struct Morph::Point {
  PointState state;
  float area = 0;  // a_i R_i^2
};

void Morph::forget() {
  last_.reset();
  entries_.clear();
}

void Morph::fill_still(const MorphInput& input, const Moment& moment,
                       const std::shared_ptr<SurfacePoints>& points) {
  forget();
  still_ = true;
  fill(input, moment, points);
  still_ = false;
}

void Morph::look(const MorphInput& input) {
  const FilteredDepth& depth = input.depth;
  if (order_.columns != depth.columns || order_.rows != depth.rows) {
    order_ = make_block_order(depth.columns, depth.rows);
    resized_ = true;
  }
  if (order_.size() == 0) forget();  // an image without a block has no place for old points
  measure(input);
}

void Morph::fill(const MorphInput& input, const Moment& moment,
                 const std::shared_ptr<SurfacePoints>& points) {
  start(input, moment, *points);
  if (moved_) follow_camera(input);
  by_block_.sort(entries_, order_.size());
  for (std::size_t place = 0; place < order_.size(); ++place) {
    if (place + kAhead < order_.size()) fetch(input.depth, order_.blocks[place + kAhead]);
    settle(input.depth, place);
  }
  writer_.end();
  std::swap(entries_, next_entries_);
  last_ = points;
  last_moment_ = moment;
  T_world_sensor_ = input.depth.T_world_sensor;
}

void Morph::start(const MorphInput& input, const Moment& moment, SurfacePoints& points) {
  const FilteredDepth& depth = input.depth;
  const Eigen::Isometry3d& T_world_sensor = depth.T_world_sensor;
  const bool far = (T_world_sensor.translation() - origin_).norm() > kFarFromOrigin;
  if (!last_ || far) origin_ = T_world_sensor.translation();
  old_shift_ = last_ ? Eigen::Vector3f((last_->origin - origin_).cast<float>())
                     : Eigen::Vector3f(Eigen::Vector3f::Zero());
  held_ = 0;
  moment_ = moment;
  progress_ = last_ ? progress(last_moment_, moment.start) : 1;
  const bool resized = std::exchange(resized_, false);
  moved_ = last_ && (resized || T_world_sensor.matrix() != T_world_sensor_.matrix());
  turn_ = T_world_sensor.linear().cast<float>();
  shift_ = (T_world_sensor.translation() - origin_).cast<float>();
  points.origin = origin_;
  points.kernel = options_.kernel;
  points.sharp_edges =
      std::find(depth.states.begin(), depth.states.end(), BlockState::fitted) != depth.states.end();
  next_entries_.clear();
  writer_.begin(points, std::max(entries_.size() + entries_.size() / 16, order_.size() / 2));
}

void Morph::measure(const MorphInput& input) {
  if (input.everywhere) {
    surface_.measure(input.depth);
    return;
  }
  const Eigen::Isometry3d T_sensor_world = input.depth.T_world_sensor.inverse();
  local_reach_.clear();
  for (const Ball& ball : input.reach) {
    local_reach_.push_back({T_sensor_world * ball.center, ball.radius});
  }
  surface_.measure(input.depth, local_reach_);
}

/// Puts every old point at the block that sees it now.
void Morph::follow_camera(const MorphInput& input) {
  place_of_block_.resize(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    place_of_block_[order_.blocks[k]] = static_cast<std::uint32_t>(k);
  }
  const Pinhole& p = input.pinhole;
  const Eigen::Array2f focal = Eigen::Array2d(p.fx, p.fy).cast<float>() / 2;
  const Eigen::Array2f center = Eigen::Array2d(p.cx - 0.5, p.cy - 0.5).cast<float>() / 2;
  const Eigen::Array2f size(static_cast<float>(order_.columns), static_cast<float>(order_.rows));
  const Eigen::Matrix3f back = turn_.transpose();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    const PointState point = old_point(static_cast<std::uint32_t>(i));
    const Eigen::Vector3f local = back * (point.position - shift_);
    const Eigen::Array2f block = local.head<2>().array() * (1 / local.z()) * focal + center + 0.5f;
    const bool inside = local.z() > 0 && (block >= 0).all() && (block < size).all();
    if (inside) {
      const Eigen::Array2i at = block.cast<int>();
      entry.place = place_of_block_[static_cast<std::size_t>(at.y() * order_.columns + at.x())];
      if (entry.kind == EntryKind::outside) entry.kind = EntryKind::live;
    } else {
      if (entry.kind == EntryKind::live) entry.kind = EntryKind::outside;
      entry.place = std::min(entry.place, static_cast<std::uint32_t>(order_.size() - 1));
    }
  }
}

PointState Morph::old_point(std::uint32_t i) const {
  const SurfacePoints& p = *last_;
  const auto u = static_cast<float>(progress_);
  const bool fades = !p.presences.empty();
  if (progress_ >= 1) {
    return {p.end_positions[i] + old_shift_,
            p.end_normals[i],
            p.end_density_weights[i],
            p.end_radii[i],
            p.end_confidences[i],
            fades ? p.end_presences[i] : 1.0f};
  }
  const auto between = [u](float a, float b) { return a + u * (b - a); };
  return {mix(p.grid.points()[i], p.end_positions[i], u) + old_shift_,
          mix_normals(p.normals[i], p.end_normals[i], u),
          between(p.density_weights[i], p.end_density_weights[i]),
          between(p.radii[i], p.end_radii[i]),
          between(p.confidences[i], p.end_confidences[i]),
          fades ? between(p.presences[i], p.end_presences[i]) : 1.0f};
}

Morph::Point Morph::new_point(const FilteredDepth& depth, std::size_t block) const {
  Point point;
  PointState& state = point.state;
  state.position = turn_ * depth.positions[block] + shift_;
  state.normal = turn_ * depth.normals[block];
  state.radius = surface_.radius(block);
  state.confidence = depth.confidences[block];
  point.area = surface_.area(block);
  state.weight = std::min(1.0f, point.area / (state.radius * state.radius));
  return point;
}

/// The curve jumps from row to row, which no processor foresees.
void Morph::fetch(const FilteredDepth& depth, std::size_t block) const {
  __builtin_prefetch(&depth.positions[block]);
  __builtin_prefetch(&depth.normals[block]);
  __builtin_prefetch(&depth.confidences[block]);
  surface_.fetch(block);
}

/// What becomes of one block: of the point that the frame has there, and of the old ones.
void Morph::settle(const FilteredDepth& depth, std::size_t place) {
  const std::span<const std::uint32_t> old = by_block_.at(place);
  const std::size_t block = order_.blocks[place];
  const bool shown = surface_.radius(block) > 0;
  if (!shown && old.empty()) return;
  place_ = static_cast<std::uint32_t>(place);
  std::uint32_t partner = kNone;
  if (shown) {
    const Point point = new_point(depth, block);
    partner = partner_of(old, point.state.position);
    const bool jumped = depth.jumped[block] != 0;
    if (partner == kNone || !follow(point, partner, jumped)) {
      appear(point);
      partner = kNone;
    }
  }
  bool held = shown;
  for (const std::uint32_t i : old) {
    if (i == partner) continue;
    const EntryKind kind = entries_[i].kind;
    if (kind == EntryKind::outside || (kind == EntryKind::live && !held)) {
      hold(i);
      held = held || kind == EntryKind::live;
    } else {
      leave(i);
    }
  }
}

/// The nearest of the points that a block has shown so far.
std::uint32_t Morph::partner_of(std::span<const std::uint32_t> old,
                                const Eigen::Vector3f& place) const {
  if (old.size() == 1) return entries_[old[0]].kind == EntryKind::live ? old[0] : kNone;
  std::uint32_t partner = kNone;
  float nearest = std::numeric_limits<float>::infinity();
  for (const std::uint32_t i : old) {
    if (entries_[i].kind != EntryKind::live) continue;
    const float squared = (old_point(i).position - place).squaredNorm();
    if (squared >= nearest) continue;
    nearest = squared;
    partner = i;
  }
  return partner;
}

/// Lets the old point go to the new one, if they are one surface. What the filter says of jumps
/// counts when both saw the point in the last frame, and from the same place.
bool Morph::follow(const Point& seen, std::uint32_t i, bool jumped) {
  if (jumped && entries_[i].seen && !moved_) return false;
  const PointState from = old_point(i);
  PointState to = seen.state;
  if ((to.position - from.position).squaredNorm() > to.radius * to.radius) return false;
  to.radius = from.radius + kShare * (to.radius - from.radius);
  to.confidence = from.confidence + kShare * (to.confidence - from.confidence);
  to.weight = std::min(1.0f, seen.area / (to.radius * to.radius));
  if (to.normal.isZero(0)) to.normal = from.normal;
  const auto rise = static_cast<float>(moment_.duration / options_.fade);
  to.presence = std::min(1.0f, from.presence + rise);
  add(from, to, {place_, EntryKind::live, true, moment_.stamp});
  return true;
}

void Morph::appear(const Point& point) {
  PointState from = point.state;
  if (!still_) from.weight = 0;
  add(from, point.state, {place_, EntryKind::live, true, moment_.stamp});
}

/// Nothing says that the point is gone, nothing that it is there.
void Morph::hold(std::uint32_t i) {
  const PointState from = old_point(i);
  const Entry& entry = entries_[i];
  const double unsure = moment_.stamp + moment_.duration - entry.confirmed - options_.silence;
  const auto sure = static_cast<float>(std::clamp(1 - unsure / options_.fade, 0.0, 1.0));
  const auto fall = static_cast<float>(moment_.duration / options_.fade);
  PointState to = from;
  to.presence = std::max(std::min(to.presence, sure), to.presence - fall);
  if (to.presence <= 0 || ++held_ > order_.size()) return leave(i);
  to.weight = last_->end_density_weights[i];
  add(from, to, {place_, entry.kind, false, entry.confirmed});
}

void Morph::leave(std::uint32_t i) {
  const PointState from = old_point(i);
  if (from.weight <= kGone) return;
  PointState to = from;
  to.weight = 0;
  add(from, to, {place_, EntryKind::leaving, false, entries_[i].confirmed});
}

void Morph::add(const PointState& from, const PointState& to, const Entry& entry) {
  writer_.add(order_.codes[place_], from, to);
  next_entries_.push_back(entry);
}

}  // namespace palpate
