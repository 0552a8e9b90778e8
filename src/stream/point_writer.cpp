// Writes moving points into the columns of surface points.
#include "stream/point_writer.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "geometry/parallel.hpp"

namespace palpate {
namespace {

// A typical radius is the median of so many points or more (judgement).
constexpr std::size_t kSample = 1024;

constexpr std::size_t kCellsAtATime = 512;  // judgement: shares work among threads

}  // namespace

void PointWriter::begin(SurfacePoints& points, std::size_t expected) {
  points_ = &points;
  count_ = 0;
  room_ = 0;
  points.materials.clear();
  points.colors.clear();
  points.edges.start.clear();
  points.edges.end.clear();
  make_room(expected);
}

std::size_t PointWriter::append(std::size_t count) {
  count_ += count;
  if (count_ > room_) make_room(count_ + count_ / 4 + 1024);
  return count_ - count;
}

void PointWriter::make_room(std::size_t room) {
  SurfacePoints& p = *points_;
  for (auto* column : {&p.normals, &p.end_positions, &p.end_normals}) column->resize(room);
  for (auto* column :
       {&p.density_weights, &p.radii, &p.confidences, &p.presences, &p.end_density_weights,
        &p.end_radii, &p.end_confidences, &p.end_presences}) {
    column->resize(room);
  }
  p.edges.of_point.resize(room);
  for (auto* edges : {&p.edges.start, &p.edges.end}) {
    if (edges->capacity() < room) edges->reserve(2 * room);
  }
  starts_.resize(std::max(room, starts_.size()));
  codes_.resize(std::max(room, codes_.size()));
  room_ = room;
}

void PointWriter::add_eye(const PointMotion& motion) {
  SurfaceEye& eye = *points_->eye;
  const Eigen::Vector3d position = points_->origin + motion.from.position.cast<double>();
  const bool is_new = motion.to_eye.isZero(0);
  eye.remembered.push_back(is_new ? (eye.position - position).normalized().cast<float>().eval()
                                  : motion.to_eye);
}

void PointWriter::write(std::size_t at, const PointMotion& motion, Extremes& extremes) {
  SurfacePoints& p = *points_;
  codes_[at] = motion.code;
  starts_[at] = motion.from.position;
  p.normals[at] = motion.from.normal;
  p.density_weights[at] = motion.from.weight;
  p.radii[at] = motion.from.radius;
  p.confidences[at] = motion.from.confidence;
  p.presences[at] = motion.from.presence;
  p.end_positions[at] = motion.to.position;
  p.end_normals[at] = motion.to.normal;
  p.end_density_weights[at] = motion.to.weight;
  p.end_radii[at] = motion.to.radius;
  p.end_confidences[at] = motion.to.confidence;
  p.end_presences[at] = motion.to.presence;
  p.edges.of_point[at] = SurfacePoints::Edges::kNone;
  extremes.add({Floats{} + std::min(motion.from.radius, motion.to.radius),
                Floats{} + std::min(motion.from.presence, motion.to.presence)});
}

void PointWriter::write(std::size_t at, const std::uint32_t* codes, const PointStates& from,
                        const PointStates& to, Extremes& extremes) {
  SurfacePoints& p = *points_;
  store(&codes_[at], load<Ints>(codes));
  store(&starts_[at], from.position);
  store(&p.normals[at], from.normal);
  store(&p.density_weights[at], from.weight);
  store(&p.radii[at], from.radius);
  store(&p.confidences[at], from.confidence);
  store(&p.presences[at], from.presence);
  store(&p.end_positions[at], to.position);
  store(&p.end_normals[at], to.normal);
  store(&p.end_density_weights[at], to.weight);
  store(&p.end_radii[at], to.radius);
  store(&p.end_confidences[at], to.confidence);
  store(&p.end_presences[at], to.presence);
  store(&p.edges.of_point[at], Ints{} - 1);  // none
  extremes.add({least(from.radius, to.radius), least(from.presence, to.presence)});
}

/// An end without an edge gets the other end's plane.
void PointWriter::add_edge(std::size_t at, const EdgeMotion& edge) {
  if (edge.start.share == 0 && edge.end.share == 0) return;
  SurfacePoints::Edges& edges = points_->edges;
  edges.of_point[at] = static_cast<std::uint32_t>(edges.start.size());
  const SurfacePoints::EdgePlane& start = edge.start.share != 0 ? edge.start : edge.end;
  const SurfacePoints::EdgePlane& end = edge.end.share != 0 ? edge.end : edge.start;
  edges.start.push_back({start.normal, start.height, edge.start.share});
  edges.end.push_back({end.normal, end.height, edge.end.share});
}

void PointWriter::end(const Extremes& extremes) {
  make_room(count_);
  if (all(extremes.presence >= 1)) {
    points_->presences.clear();
    points_->end_presences.clear();
  }
  points_->grid.rebuild(std::span(starts_).first(count_), std::span(codes_).first(count_),
                        points_->end_positions);
  measure_reach();
  const Floats& r = extremes.radius;
  const float smallest = std::min({r[0], r[1], r[2], r[3]});
  points_->smallest_radius = count_ > 0 ? smallest : 0;
  measure_radii();
}

// For each cell the largest R_i in it: its box contains the points' paths.
void PointWriter::measure_reach() {
  const std::span<const CellGrid::Cell> cells = points_->grid.cells();
  std::vector<float>& reach = points_->cell_reach;
  reach.resize(cells.size());
  detail::parallel_each(cells.size(), kCellsAtATime, [&](std::size_t c) {
    const CellGrid::Cell& cell = cells[c];
    reach[c] = 0;
    for (std::uint32_t i = cell.begin; cell.children == 0 && i < cell.end; ++i) {
      reach[c] = std::max(reach[c], std::max(points_->radii[i], points_->end_radii[i]));
    }
  });
  for (std::size_t c = cells.size(); c-- > 0;) {  // children stand behind their parents
    for (std::uint32_t k = 0; k < cells[c].children; ++k) {
      reach[c] = std::max(reach[c], reach[cells[c].first_child + k]);
    }
  }
}

void PointWriter::measure_radii() {
  const std::vector<float>& radii = points_->end_radii;
  points_->radius = 0;
  if (radii.empty()) return;
  const std::size_t step = std::max<std::size_t>(1, radii.size() / kSample);
  sample_.clear();
  for (std::size_t i = 0; i < radii.size(); i += step) sample_.push_back(radii[i]);
  const auto middle = sample_.begin() + static_cast<std::ptrdiff_t>(sample_.size() / 2);
  std::nth_element(sample_.begin(), middle, sample_.end());
  points_->radius = *middle;
}

}  // namespace palpate
