// Measures how far a proxy follows the hand along a surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "palpate/servo/guard.hpp"

namespace palpate {

/// From the hand to the proxy, m.
[[nodiscard]] inline Eigen::Vector3d stretch(const Guard::Input& input) noexcept {
  if (!(input.stiffness > 0)) return Eigen::Vector3d::Zero();
  return input.force / input.stiffness;
}

[[nodiscard]] inline Eigen::Vector3d tangential(const Eigen::Vector3d& v,
                                                const Eigen::Vector3d& normal) noexcept {
  return v - v.dot(normal) * normal;
}

/// Share of the hand's displacement along the surface that the proxy follows, smoothed; 1 at the
/// first touch.
class SlidingShare {
 public:
  void begin(const Guard::Input& input) noexcept {
    stretch_ = stretch(input);
    share_ = 1;
  }

  /// `before`: the step before; `displacement`: the hand's against the surface since then, m.
  void update(const Guard::Input& before, const Guard::Input& input,
              const Eigen::Vector3d& displacement) noexcept {
    share_ = measured(before, input, displacement);
  }

  /// The step is over.
  void remember(const Guard::Input& input) noexcept { stretch_ = stretch(input); }

  [[nodiscard]] double share() const noexcept { return share_; }

 private:
  [[nodiscard]] double measured(const Guard::Input& before, const Guard::Input& input,
                                const Eigen::Vector3d& displacement) const noexcept {
    if (before.normal.isZero(0) || before.stiffness == 0 || input.stiffness == 0) return 1;
    const Eigen::Vector3d along = tangential(displacement, input.normal);
    const double square = along.squaredNorm();
    if (!(square > 0)) return share_;
    const Eigen::Vector3d proxy_displacement = displacement + stretch(input) - stretch_;
    // std::max turns NaN (0 / 0 at a tiny stiffness) into 0.
    const double share = std::min(1.0, std::max(0.0, proxy_displacement.dot(along) / square));
    return share_ + Guard::kSmoothing * (share - share_);
  }

  Eigen::Vector3d stretch_ = Eigen::Vector3d::Zero();  // in the step before, m
  double share_ = 1;
};

}  // namespace palpate
