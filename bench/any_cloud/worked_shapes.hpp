#pragma once

#include "any_cloud/shape.hpp"

namespace palpate::any_cloud {

// Bodies as machines and nature work them: bounds of the distance, whose gradients are no longer
// than 1, with exact surfaces. Lengths in spacings.

/// The common part of two solids.
[[nodiscard]] Shape both(Shape a, Shape b);

/// A block of half sizes `half` whose top waves by +- `height` along x and y.
[[nodiscard]] Shape relief(const Eigen::Vector3d& half, double wavelength, double height);

/// A block whose top is a saddle, +- `height` high at the middles of its sides.
[[nodiscard]] Shape saddle(const Eigen::Vector3d& half, double height);

/// A bolt along z between -length / 2 and length / 2, whose radius winds by +- `depth`.
[[nodiscard]] Shape thread(double radius, double length, double pitch, double depth);

/// A plate that carries teeth `tooth` thick, as far apart.
[[nodiscard]] Shape comb(double tooth, int teeth, double height, double width);

/// Rods of `radius` along all axes, `pitch` apart, `count` each way.
[[nodiscard]] Shape lattice(double pitch, double radius, int count);

/// A hollow ball, open at the top.
[[nodiscard]] Shape cup(double outer, double inner);

/// A rod wound around z, with closed ends that are cut flat.
[[nodiscard]] Shape spring(double radius, double wire, double pitch, double turns);

}  // namespace palpate::any_cloud
