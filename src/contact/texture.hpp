#pragma once

#include <Eigen/Core>

#include "palpate/contact/proxy.hpp"

namespace palpate {

/// The height that a texture adds to the surface and its gradient; the height is never above 0.
struct Relief {
  double height = 0;  ///< m, in [-2 amplitude, 0]
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// The relief at x (m, world).
[[nodiscard]] Relief relief_at(const Texture& texture, const Eigen::Vector3d& x) noexcept;

}  // namespace palpate
