// Computes where the points that were shown last are by now.
#include "stream/shown_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field/selection.hpp"

namespace palpate {
namespace {

constexpr float kNoLength = 1e-6f;  // of the sum of two unit normals: they cancel (judgement)

Eigen::Vector3f mix(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float u) {
  return a + u * (b - a);
}

Eigen::Vector3f mix_normals(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float u) {
  const Eigen::Vector3f mixed = mix(a, b, u);
  const float length = mixed.norm();
  return length > kNoLength ? Eigen::Vector3f(mixed / length) : a;
}

Floats mix(const Floats& a, const Floats& b, float u) {
  return a + u * (b - a);
}

Vectors mix(const Vectors& a, const Vectors& b, float u) {
  return a + (Floats{} + u) * (b - a);
}

Vectors mix_normals(const Vectors& a, const Vectors& b, float u) {
  const Vectors mixed = mix(a, b, u);
  Floats length = dot(mixed, mixed);
  for (int l = 0; l < kLanes; ++l) length[l] = std::sqrt(length[l]);
  const Vectors unit{mixed.x / length, mixed.y / length, mixed.z / length};
  return choose(length > kNoLength, unit, a);
}

}  // namespace

void ShownPoints::begin(const FrameTiming& next, const Eigen::Vector3d& origin) {
  shift_ = points_ ? Eigen::Vector3f((points_->origin - origin).cast<float>())
                   : Eigen::Vector3f(Eigen::Vector3f::Zero());
  progress_ = points_ ? progress(moment_, next.start) : 1;
}

void ShownPoints::replace(std::shared_ptr<const SurfacePoints> points, const FrameTiming& moment,
                          std::vector<Entry>& entries) {
  points_ = std::move(points);
  moment_ = moment;
  std::swap(entries_, entries);
}

Eigen::Vector3f ShownPoints::to_eye(std::uint32_t i) const {
  const auto& remembered = points_->eye->remembered;
  const std::size_t first = points_->size() - remembered.size();
  if (i >= first) return remembered[i - first];
  const Eigen::Vector3d position = points_->origin + points_->grid.points()[i].cast<double>();
  return (points_->eye->position - position).normalized().cast<float>();
}

void ShownPoints::forget() {
  points_.reset();
  entries_.clear();
}

PointState ShownPoints::at(std::uint32_t i) const {
  const SurfacePoints& p = *points_;
  const auto u = static_cast<float>(progress_);
  const bool fades = !p.presences.empty();
  if (progress_ >= 1) {
    return {p.end_positions[i] + shift_, p.end_normals[i],
            p.end_density_weights[i],    p.end_radii[i],
            p.end_confidences[i],        fades ? p.end_presences[i] : 1.0f};
  }
  const auto between = [u](float a, float b) { return a + u * (b - a); };
  return {mix(p.grid.points()[i], p.end_positions[i], u) + shift_,
          mix_normals(p.normals[i], p.end_normals[i], u),
          between(p.density_weights[i], p.end_density_weights[i]),
          between(p.radii[i], p.end_radii[i]),
          between(p.confidences[i], p.end_confidences[i]),
          fades ? between(p.presences[i], p.end_presences[i]) : 1.0f};
}

PointStates ShownPoints::end_of_four(std::uint32_t i) const {
  const SurfacePoints& p = *points_;
  const auto end = [i](const auto& column) { return load<Floats>(&column[i]); };
  return {load(&p.end_positions[i]) + all_lanes(shift_),
          load(&p.end_normals[i]),
          end(p.end_density_weights),
          end(p.end_radii),
          end(p.end_confidences),
          p.presences.empty() ? Floats{} + 1.0f : end(p.end_presences)};
}

PointStates ShownPoints::four_at(std::uint32_t i) const {
  if (progress_ >= 1) return end_of_four(i);
  const SurfacePoints& p = *points_;
  const auto u = static_cast<float>(progress_);
  const auto between = [i, u](const auto& a, const auto& b) {
    return mix(load<Floats>(&a[i]), load<Floats>(&b[i]), u);
  };
  return {mix(load(&p.grid.points()[i]), load(&p.end_positions[i]), u) + all_lanes(shift_),
          mix_normals(load(&p.normals[i]), load(&p.end_normals[i]), u),
          between(p.density_weights, p.end_density_weights),
          between(p.radii, p.end_radii),
          between(p.confidences, p.end_confidences),
          p.presences.empty() ? Floats{} + 1.0f : between(p.presences, p.end_presences)};
}

float ShownPoints::speed_of(std::uint32_t i) const {
  if (!(moment_.duration > 0)) return 0;
  const Eigen::Vector3f offset = points_->end_positions[i] - points_->grid.points()[i];
  return std::abs(offset.dot(points_->end_normals[i])) / static_cast<float>(moment_.duration);
}

SurfacePoints::EdgePlane ShownPoints::edge_of(std::uint32_t i) const {
  return edge_now({.points = points_.get(), .progress = std::min(progress_, 1.0)}, i);
}

}  // namespace palpate
