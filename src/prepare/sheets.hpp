#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// What the sheet of each point is like, in sorted order.
struct OwnSheets {
  std::vector<Eigen::Vector3f> normals;  ///< unit, sign arbitrary; zero: undefined
  std::vector<float> confidences;        ///< planarity, 0-1
  std::vector<float> residuals;          ///< from the plane, m
  std::vector<float> bends;              ///< from the quadric where the plane does not fit, m
  std::vector<std::uint8_t> others;      ///< 1: points of other sheets are around
};

// Normals come from a little further away than the surface: the balanced field adds their noise.
inline constexpr float kNormalsReach = 1.15f;  // of R

/// Fitted within kNormalsReach of each point's `radii`; `noise`: of the points, m. On every core.
[[nodiscard]] OwnSheets fit_own_sheets(const CellGrid& grid, std::span<const float> spacings,
                                       std::span<const float> radii, double noise);

/// Sorted points and what is known of them before sheets.
struct SheetInput {
  const CellGrid& grid;
  std::span<const float> spacings;  // m
  std::span<const float> radii;     // m
  double noise = 0;                 // m
};

/// What is known of signs from outside.
struct KnownSigns {
  std::span<const Eigen::Vector3f> given;  ///< normals in sorted order, some of them maybe zero or
                                           ///< not finite; empty: none
  std::optional<Eigen::Vector3f> eye;      ///< of the sensor, in the grid's frame, m
};

/// A point that lies on a second sheet, too, where two meet in a crease or at an edge.
struct Twin {
  std::uint32_t point = 0;
  std::uint32_t host = 0;  ///< a point that is surely on that sheet
};

/// Puts each point on a sheet: sure points that continue each other's planes make one; an unsure
/// point joins the sheet whose plane it lies on and takes over its fit. One that lies on none has
/// no confidence left. Turns `own.normals` so that they agree within a part, outward where nothing
/// else is known.
///
/// Two sheets that lie side by side are one part where nearby pairs of their points agree on what
/// is outside: n_p, mirrored by the plane halfway between p and q, looks like n_q, as if an arc
/// joined the two. Where the signs of nearly all points of a sheet are known, these count instead.
/// `twins`: gets the points that lie on two sheets, in rising order.
[[nodiscard]] SurfacePoints::Sheets make_sheets(const SheetInput& input, const KnownSigns& known,
                                                OwnSheets& own, std::vector<Twin>& twins);

}  // namespace palpate
