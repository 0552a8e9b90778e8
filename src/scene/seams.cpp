#include "scene/seams.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "scene/disagreement.hpp"

namespace palpate {
namespace {

constexpr double kWidth = 2.5;     // R, in distances between two surfaces
constexpr double kFarthest = 1.5;  // distance of what may be one surface, in R
constexpr double kNoise = 0.1;     // of R; what is measured varies from frame to frame

/// The R, m, that makes one surface of two; 0: they are one, or lie too far apart. `before`: what
/// it was.
double common_radius(const Source& one, const Source& other, double before) {
  const std::shared_ptr<const SurfacePoints> a = one.points();
  const std::shared_ptr<const SurfacePoints> b = other.points();
  if (!a || !b) return 0;
  const double own = std::min(a->radius, b->radius);
  const double radius = kWidth * disagreement(*a, *b).value_or(0);
  const double most = (before > 0 ? 1 + kNoise : 1) * kWidth * kFarthest * own;
  if (radius <= own || radius > most) return 0;
  return std::abs(radius - before) <= kNoise * before ? before : radius;
}

}  // namespace

void Seams::compare(std::size_t place, const Source& source) {
  const std::lock_guard lock(mutex_);
  sources_[place] = &source;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    if (k == place || sources_[k] == nullptr) continue;
    const auto [first, second] = std::minmax(k, place);  // one order: noise is the same both ways
    common_[k][place] = common_[place][k] =
        common_radius(*sources_[first], *sources_[second], common_[k][place]);
  }
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    least_radii_[k].store(*std::ranges::max_element(common_[k]));
  }
}

}  // namespace palpate
