#include "scene/policies/point_writer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace palpate {
namespace {

// A typical radius is the median of so many points or more.
constexpr std::size_t kSample = 1024;

}  // namespace

void PointWriter::begin(SurfacePoints& points, std::size_t expected) {
  points_ = &points;
  count_ = 0;
  room_ = 0;
  unsure_ = false;
  points.materials.clear();
  points.colors.clear();
  points.edges.start.clear();
  points.edges.end.clear();
  make_room(expected);
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

/// Where there is none, there is the other end's plane.
std::uint32_t PointWriter::add_edge(const EdgeWay& edge) {
  PointEdges& edges = points_->edges;
  const auto number = static_cast<std::uint32_t>(edges.start.size());
  const EdgePlane& start = edge.start.share != 0 ? edge.start : edge.end;
  const EdgePlane& end = edge.end.share != 0 ? edge.end : edge.start;
  edges.start.push_back({start.normal, start.height, edge.start.share});
  edges.end.push_back({end.normal, end.height, edge.end.share});
  return number;
}

void PointWriter::end() {
  make_room(count_);
  if (!unsure_) {
    points_->presences.clear();
    points_->end_presences.clear();
  }
  points_->grid.rebuild(std::span(starts_).first(count_), std::span(codes_).first(count_),
                        points_->end_positions);
  measure_reach();
  measure_radii();
}

// For each cell the largest R_i in it: its box holds the points' ways.
void PointWriter::measure_reach() {
  const std::span<const CellGrid::Cell> cells = points_->grid.cells();
  std::vector<float>& reach = points_->cell_reach;
  reach.resize(cells.size());
  for (std::size_t c = cells.size(); c-- > 0;) {  // children stand behind their parents
    const CellGrid::Cell& cell = cells[c];
    float largest = 0;
    for (std::uint32_t k = 0; k < cell.children; ++k) {
      largest = std::max(largest, reach[cell.first_child + k]);
    }
    for (std::uint32_t i = cell.begin; cell.children == 0 && i < cell.end; ++i) {
      largest = std::max(largest, std::max(points_->radii[i], points_->end_radii[i]));
    }
    reach[c] = largest;
  }
}

void PointWriter::measure_radii() {
  const std::vector<float>& radii = points_->end_radii;
  points_->radius = 0;
  points_->smallest_radius = 0;
  if (radii.empty()) return;
  points_->smallest_radius =
      std::min(*std::min_element(points_->radii.begin(), points_->radii.end()),
               *std::min_element(radii.begin(), radii.end()));
  const std::size_t step = std::max<std::size_t>(1, radii.size() / kSample);
  sample_.clear();
  for (std::size_t i = 0; i < radii.size(); i += step) sample_.push_back(radii[i]);
  const auto middle = sample_.begin() + static_cast<std::ptrdiff_t>(sample_.size() / 2);
  std::nth_element(sample_.begin(), middle, sample_.end());
  points_->radius = *middle;
}

}  // namespace palpate
