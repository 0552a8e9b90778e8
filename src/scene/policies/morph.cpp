// Makes the surface of a depth frame out of the one before it.
#include "scene/policies/morph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "field/selection.hpp"
#include "geometry/parallel.hpp"

namespace palpate {
namespace {

// Places that are settled together: as many as a processor's cache holds, for so many threads.
constexpr std::size_t kPlaces = 512;
constexpr std::size_t kPieces = 16;  // judgement, as the next
constexpr std::size_t kAhead = 64;   // places that are prefetched before they are settled

// Unseen points come behind all seen ones, on a curve through space: cells of the index along
// the image's would be as deep as the scene. Codes of blocks are below it.
constexpr std::uint32_t kUnseenCode = 1u << 30;
constexpr float kUnseenSteps = 1023;  // of that curve along an axis

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

void Morph::forget() {
  last_.reset();
  entries_.clear();
}

void Morph::fill_still(const MorphInput& input, const FrameTiming& moment,
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
    place_of_block_.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      place_of_block_[order_.blocks[k]] = static_cast<std::uint32_t>(k);
    }
    unseen_.reserve(order_.size());
    unseen_order_.reserve(order_.size());
    sorting_.reserve(order_.size());
    resized_ = true;
  }
  if (order_.size() == 0) forget();  // an image without a block has no place for old points
  measure(input);
  edges_.look(depth, surface_);
}

void Morph::fill(const MorphInput& input, const FrameTiming& moment,
                 const std::shared_ptr<SurfacePoints>& points) {
  start(input, moment, *points);
  if (moved_) follow_camera(input);
  by_block_.sort(entries_, order_.size());
  pieces_.resize(kPieces);
  extremes_ = {};
  for (std::size_t place = 0; place < order_.size(); place += kPieces * kPlaces) {
    settle(input.depth, place, std::min(order_.size(), place + kPieces * kPlaces));
  }
  write_unseen();
  writer_.end(extremes_);
  std::swap(entries_, next_entries_);
  last_ = points;
  last_moment_ = moment;
  T_world_sensor_ = input.depth.T_world_sensor;
}

/// Places of the curve, shared out: what becomes of their points is decided, then there is known
/// where they stand among all, then they are written.
void Morph::settle(const FilteredDepth& depth, std::size_t begin, std::size_t end) {
  const std::size_t pieces = (end - begin + kPlaces - 1) / kPlaces;
  detail::parallel_each(pieces, 1, [&](std::size_t k) {
    const std::size_t first = begin + k * kPlaces;
    look_at(depth, first, std::min(end, first + kPlaces), pieces_[k]);
  });
  for (std::size_t k = 0; k < pieces; ++k) {
    Piece& piece = pieces_[k];
    piece.first = writer_.append(piece.count);
    gather_unseen(piece);
  }
  next_entries_.resize(writer_.count());
  detail::parallel_each(pieces, 1, [&](std::size_t k) { write(pieces_[k]); });
  for (std::size_t k = 0; k < pieces; ++k) {
    extremes_.add(pieces_[k].extremes);
    for (const auto& [at, edge] : pieces_[k].edges) writer_.add_edge(at, edge);
  }
}

void Morph::look_at(const FilteredDepth& depth, std::size_t begin, std::size_t end,
                    Piece& piece) const {
  piece.going_on.clear();
  piece.shown.clear();
  piece.unseen.clear();
  for (std::size_t place = begin; place < end; place += kLanes) {
    prefetch(depth, place + kAhead);
    const Four four = new_points(depth, place);
    FourWays& ways = piece.going_on.emplace_back();
    if (place + kLanes <= end && goes_on(four, ways)) continue;
    piece.going_on.pop_back();
    for (int l = 0; l < kLanes && place + l < end; ++l) settle(depth, point_of(four, l), piece);
  }
  piece.count = kLanes * piece.going_on.size() + piece.shown.size();
}

void Morph::write(Piece& piece) {
  piece.extremes = {};
  piece.edges.clear();
  std::size_t at = piece.first;
  auto four = piece.going_on.begin();
  const auto write_fours_before = [&](std::size_t place) {
    for (; four != piece.going_on.end() && four->place < place; ++four, at += kLanes) {
      write(at, *four, piece);
    }
  };
  for (const Way& way : piece.shown) {
    write_fours_before(way.entry.place);
    write(at++, way, piece);
  }
  write_fours_before(order_.size());
}

void Morph::write(std::size_t at, const Way& way, Piece& piece) {
  writer_.write(at, way, piece.extremes);
  if (way.edge.start.share != 0 || way.edge.end.share != 0) piece.edges.push_back({at, way.edge});
  next_entries_[at] = way.entry;
}

void Morph::write_unseen() {
  using Eigen::Array3f;
  Array3f lower = Array3f::Constant(std::numeric_limits<float>::max());
  Array3f upper = -lower;
  for (const Way& unseen : unseen_) {
    lower = lower.min(unseen.from.position.array());
    upper = upper.max(unseen.from.position.array());
  }
  const float extent = std::max((upper - lower).maxCoeff(), std::numeric_limits<float>::min());
  unseen_order_.clear();
  for (std::size_t i = 0; i < unseen_.size(); ++i) {
    const Array3f share = (unseen_[i].from.position.array() - lower) / extent;
    const Eigen::Array<std::uint32_t, 3, 1> cell = (kUnseenSteps * share).cast<std::uint32_t>();
    const std::uint64_t code = detail::morton_key(cell.x(), cell.y(), cell.z());
    unseen_order_.push_back(code << detail::kPlaceBits | i);
  }
  sorting_.resize(unseen_order_.size());
  detail::sort_records(unseen_order_, sorting_, detail::kKeyBits);
  std::size_t at = writer_.append(unseen_.size());
  next_entries_.resize(writer_.count());
  for (const detail::Record record : unseen_order_) {
    Way& unseen = unseen_[record & detail::kPlaceMask];
    unseen.code = kUnseenCode | static_cast<std::uint32_t>(record >> detail::kPlaceBits);
    writer_.write(at, unseen, extremes_);
    writer_.add_edge(at, unseen.edge);
    next_entries_[at++] = unseen.entry;
  }
}

void Morph::start(const MorphInput& input, const FrameTiming& moment, SurfacePoints& points) {
  const FilteredDepth& depth = input.depth;
  const Eigen::Isometry3d& T_world_sensor = depth.T_world_sensor;
  const bool far = (T_world_sensor.translation() - origin_).norm() > kFarFromOrigin;
  if (!last_ || far) origin_ = T_world_sensor.translation();
  old_shift_ = last_ ? Eigen::Vector3f((last_->origin - origin_).cast<float>())
                     : Eigen::Vector3f(Eigen::Vector3f::Zero());
  held_ = 0;
  moment_ = moment;
  ends_ = input.last;
  streams_ = last_ && (streams_ || moment.stamp != last_moment_.stamp);
  comes_ = input.last ? 1 : share_of(options_.fade);
  doubt_ = std::exp(share_of(options_.fade));
  progress_ = last_ ? progress(last_moment_, moment.start) : 1;
  const bool resized = std::exchange(resized_, false);
  moved_ = last_ && (resized || T_world_sensor.matrix() != T_world_sensor_.matrix());
  turn_ = T_world_sensor.linear().cast<float>();
  shift_ = (T_world_sensor.translation() - origin_).cast<float>();
  points.origin = origin_;
  points.kernel = options_.kernel;
  points.one_sided = true;
  unseen_.clear();
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
      const bool stays = entry.kind == EntryKind::live || entry.kind == EntryKind::hidden;
      if (stays) entry.kind = EntryKind::outside;
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

SurfacePoints::EdgePlane Morph::old_edge(std::uint32_t i) const {
  return edge_now({.points = last_.get(), .progress = std::min(progress_, 1.0)}, i);
}

/// The edge of a point that the frame shows, in the world frame.
SurfacePoints::EdgePlane Morph::new_edge(const Point& point) const {
  if (point.edge == kNone) return {};
  const SurfacePoints::EdgePlane& edge = edges_.plane(point.edge);
  return {turn_ * edge.normal, edge.height, edge.share};
}

}  // namespace palpate
