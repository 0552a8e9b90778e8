#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "palpate/field/field.hpp"

namespace palpate::viewer {

/// Triangles around a centre that is known apart. Seen from the free side their corners go
/// anticlockwise.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  ///< m, relative to the centre
  std::vector<std::array<std::uint16_t, 3>> triangles;
};

/// Where a surface is to be meshed.
struct LocalRegion {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m
  double radius = 0;  ///< R, m; the mesh reaches kReach of it to every side
  /// Where there is less support the surface is left out: the back of a sheet, where the solid
  /// ends because nothing is known behind it.
  double least_support = 0;
};

/// R's to every side of the centre.
inline constexpr double kReach = 2.4;

/// The surface of `field` in a cube (surface nets): what can be felt there, as far as it is known.
/// Cubes that are free are passed over, and no more than 32^3 cells looked at, so that it costs a
/// few thousand samples.
[[nodiscard]] Mesh local_surface(const Field& field, const LocalRegion& region);

}  // namespace palpate::viewer
