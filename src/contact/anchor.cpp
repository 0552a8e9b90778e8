#include "contact/anchor.hpp"

#include <algorithm>
#include <cmath>

#include "contact/sweep.hpp"

namespace palpate {
namespace {

constexpr double kLeastNormal = 0.5;
constexpr double kSameWay = 0.3;     // cosine between the old and the new normal
constexpr double kLifted = 0.02;     // of R: the surface left the proxy
constexpr double kSunk = 1e-3;       // of R: beyond Newton's rounding, the surface rose over it
constexpr double kLeastReach = 0.5;  // of R
constexpr int kRecoverySteps = 8;
constexpr double kRecoveryStep = 0.25;  // of R

}  // namespace

bool surface_moved(const Probe& probe, const Sample& here, const Eigen::Vector3d& normal,
                   bool changed) noexcept {
  if (normal.norm() < kLeastNormal) return false;
  const std::optional<double> distance = first_order_distance(here);
  if (!distance) return true;
  const double radius = probe.step_length();
  if (*distance < -kSunk * radius || *distance > kLifted * radius) return true;
  return changed && *distance > kSunk * radius;
}

std::optional<SurfacePoint> reanchor(Probe& probe, const Eigen::Vector3d& position,
                                     const Eigen::Vector3d& normal) noexcept {
  const double reach = std::max(probe.traits().reanchor_reach, kLeastReach * probe.step_length());
  const Eigen::Vector3d top = position + reach * normal;
  if (probe.inside(top)) return std::nullopt;
  const Sweep way = first_contact(probe, top, position);
  if (way.end != Sweep::End::hit) return std::nullopt;
  const std::optional<SurfacePoint> found = project(probe, way.position);
  return found && found->normal.dot(normal) > kSameWay ? found : std::nullopt;
}

std::optional<SurfacePoint> recover(Probe& probe, const Eigen::Vector3d& position,
                                    const Eigen::Vector3d& normal) noexcept {
  if (normal.norm() < kLeastNormal) return std::nullopt;
  const double radius = probe.step_length();
  for (int k = 1; k <= kRecoverySteps; ++k) {
    const Eigen::Vector3d place = position + k * kRecoveryStep * radius * normal;
    const Sample here = probe.sample(place);
    if (here.value > 0) return project(probe, place, here);
  }
  return std::nullopt;
}

}  // namespace palpate
