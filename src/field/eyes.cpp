// Decides whether a surface holds, by the eyes that saw its points.
#include "field/eyes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

using Eigen::Vector3d;

// Cosine between a gradient and the ray to an eye, the least that holds: beyond 90 degrees noise
// turns right normals. From 0 to -0.7 as many hands are held (measured, docs/method.md 2.11).
constexpr double kFaces = -0.1;
// Share of the weight at a position: a source with less has no surface there (judgement).
constexpr double kFaintSource = 0.1;
// Cosine between directions to one eye. An error of 18 degrees is far below what kFaces leaves
// between the sides of a surface (derived).
constexpr double kSameEye = 0.95;
// What that cosine falls by where there are more directions than room: from 18 to 26, 32, ...
// degrees. The smaller the steps, the less are merged; judgement.
constexpr double kMerge = 0.05;

}  // namespace

void Eyes::begin(const Vector3d& center) noexcept {
  center_ = center;
  count_ = 0;
  direction_count_ = 0;
  same_ = kSameEye;
  unseen_ = 0;
}

void Eyes::add(const Eye& eye) noexcept {
  const auto same = [&](const Eye& other) {
    return other.source == eye.source && other.position == eye.position;
  };
  const auto known = std::span(eyes_).first(count_);
  if (count_ < kMost && std::ranges::none_of(known, same)) eyes_[count_++] = eye;
}

bool Eyes::has_direction(const Eye& eye) const noexcept {
  return std::ranges::any_of(std::span(directions_).first(direction_count_), [&](const Eye& other) {
    return other.source == eye.source && other.position.dot(eye.position) > same_;
  });
}

/// Directions are merged, and none is dropped: what speaks for one is within same_ of it.
void Eyes::add_direction(const Eye& eye) noexcept {
  while (!has_direction(eye)) {
    if (direction_count_ < kMostDirections) return void(directions_[direction_count_++] = eye);
    merge_directions();
  }
}

/// Makes room, if it can: at a cosine of -1 one direction a source is left.
void Eyes::merge_directions() noexcept {
  same_ -= kMerge;
  const std::size_t count = std::exchange(direction_count_, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (!has_direction(directions_[k])) directions_[direction_count_++] = directions_[k];
  }
}

void Eyes::add(const ActiveLayer& layer, std::span<const std::uint32_t> indices) noexcept {
  const SurfacePoints& points = *layer.points;
  const auto source = static_cast<std::size_t>(layer.source);
  if (indices.empty()) return;
  if (!points.eye) {
    unseen_ |= 1u << source;
    return;
  }
  const auto& remembered = points.eye->remembered;
  const auto first = static_cast<std::uint32_t>(points.size() - remembered.size());
  if (indices.front() < first) add(Eye{source, points.eye->position - center_});
  for (auto at = std::ranges::lower_bound(indices, first); at != indices.end(); ++at) {
    add_direction(Eye{source, remembered[*at - first].cast<double>()});
  }
}

bool Eyes::hold(const Vector3d& x, const Vector3d& gradient,
                std::span<const double> weights) const noexcept {
  double all = 0;
  for (const double w : weights) all += w;
  const auto counts = [&](std::size_t source) { return weights[source] >= kFaintSource * all; };
  for (std::size_t s = 0; unseen_ != 0 && s < weights.size(); ++s) {
    if ((unseen_ >> s & 1u) != 0 && counts(s)) return true;
  }
  const double least = kFaces * gradient.norm();
  const auto faces = [&](const Eye& eye, const Vector3d& ray) {
    return counts(eye.source) && gradient.dot(ray) >= least * ray.norm();
  };
  return std::ranges::any_of(std::span(eyes_).first(count_),
                             [&](const Eye& eye) { return faces(eye, eye.position - x); }) ||
         std::ranges::any_of(std::span(directions_).first(direction_count_),
                             [&](const Eye& eye) { return faces(eye, eye.position); });
}

}  // namespace palpate
