// Decides whether a surface holds, by the eyes that saw its points.
#include "field/eyes.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

void Eyes::begin(const Vector3d& center) noexcept {
  center_ = center;
  count_ = 0;
  unseen_ = 0;
}

void Eyes::add(const Eye& eye) noexcept {
  const auto same = [&](const Eye& other) {
    return other.source == eye.source && other.remembered == eye.remembered &&
           (eye.remembered ? other.position.dot(eye.position) > kSameEye
                           : other.position == eye.position);
  };
  const auto end = eyes_.begin() + static_cast<std::ptrdiff_t>(count_);
  if (count_ < kMost && std::none_of(eyes_.begin(), end, same)) eyes_[count_++] = eye;
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
  if (indices.front() < first) add(Eye{source, false, points.eye->position - center_});
  for (auto at = std::ranges::lower_bound(indices, first); at != indices.end(); ++at) {
    add(Eye{source, true, remembered[*at - first].cast<double>()});
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
  for (std::size_t k = 0; k < count_; ++k) {
    const Eye& eye = eyes_[k];
    if (!counts(eye.source)) continue;
    const Vector3d ray = eye.remembered ? eye.position : eye.position - x;
    if (gradient.dot(ray) >= least * ray.norm()) return true;
  }
  return false;
}

}  // namespace palpate
