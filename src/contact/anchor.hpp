#pragma once

#include <optional>

#include "contact/newton.hpp"

namespace palpate {

/// Has the surface moved over the proxy, or away from under it (algorithm.md 2.4)? `here`: the
/// sample at the proxy; `normal`: of its last contact, zero if none; `changed`: the field's
/// revision is another than in the last step.
[[nodiscard]] bool surface_moved(const Probe& probe, const Sample& here,
                                 const Eigen::Vector3d& normal, bool changed) noexcept;

/// Looks for the surface from above, along the last normal, within the field's re-anchor reach (at
/// least R / 2). Empty when there is none that faces the same way.
[[nodiscard]] std::optional<SurfacePoint> reanchor(Probe& probe, const Eigen::Vector3d& position,
                                                   const Eigen::Vector3d& normal) noexcept;

/// Looks for the surface after Newton has failed: from the first free place along the last normal,
/// up to 2 R away.
[[nodiscard]] std::optional<SurfacePoint> recover(Probe& probe, const Eigen::Vector3d& position,
                                                  const Eigen::Vector3d& normal) noexcept;

}  // namespace palpate
