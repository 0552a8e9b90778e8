// Measures how far a proxy follows the hand along a surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "palpate/servo/guard.hpp"

namespace palpate {

template <class Vector>
[[nodiscard]] Vector tangential(const Vector& v, const Vector& normal) noexcept {
  return v - v.dot(normal) * normal;
}

/// Share of the hand's displacement along the surface that the proxy follows, smoothed; 1 at the
/// first touch. `Input`: Guard::Input, or the same with vectors of more axes.
template <class Input>
class SlidingShare {
 public:
  using Vector = decltype(Input::force);

  void begin(const Input& input) noexcept {
    stretch_ = stretch(input);
    share_ = 1;
  }

  /// `before`: the step before; `displacement`: the hand's against the surface since then, m.
  void update(const Input& before, const Input& input, const Vector& displacement) noexcept {
    share_ = measured(before, input, displacement);
  }

  /// The step is over.
  void remember(const Input& input) noexcept { stretch_ = stretch(input); }

  [[nodiscard]] double share() const noexcept { return share_; }

 private:
  // From the hand to the proxy, m.
  [[nodiscard]] static Vector stretch(const Input& input) noexcept {
    if (!(input.stiffness > 0)) return Vector::Zero();
    return input.force / input.stiffness;
  }

  [[nodiscard]] double measured(const Input& before, const Input& input,
                                const Vector& displacement) const noexcept {
    if (before.normal.isZero(0) || before.stiffness == 0 || input.stiffness == 0) return 1;
    const Vector along = tangential(displacement, input.normal);
    const double square = along.squaredNorm();
    if (!(square > 0)) return share_;
    const Vector proxy_displacement = displacement + stretch(input) - stretch_;
    // std::max turns NaN (0 / 0 at a tiny stiffness) into 0.
    const double share = std::min(1.0, std::max(0.0, proxy_displacement.dot(along) / square));
    return share_ + Guard::kSmoothing * (share - share_);
  }

  Vector stretch_ = Vector::Zero();  // in the step before, m
  double share_ = 1;
};

}  // namespace palpate
