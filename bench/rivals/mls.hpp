#pragma once

#include <optional>

#include "rivals/near_points.hpp"

namespace palpate::rivals {

/// A place of the moving-least-squares surface and its outward normal.
struct MlsFoot {
  Eigen::Vector3d place;
  Eigen::Vector3d normal;
};

/// Projects x onto the surface (Alexa et al. 2003): three times a plane by weighted covariance
/// around the foot, whose weights are exp(-(d / width)^2); then a quadratic polynomial over it.
/// None where there are too few points.
[[nodiscard]] std::optional<MlsFoot> project_mls(const NearPoints& points, double width,
                                                 const Eigen::Vector3d& x);

}  // namespace palpate::rivals
