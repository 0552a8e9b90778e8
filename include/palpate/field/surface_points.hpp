// Surface points: the data that a field is evaluated from.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/field/field_options.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// Where surface points were seen from.
struct SurfaceEye {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world frame, m
  /// Unit directions, world frame, from the last points of the index to where each was seen from:
  /// what a camera remembers while it moves on. All others are seen from `position`.
  std::vector<Eigen::Vector3f> remembered = {};
};

/// Indexed points with all that a field needs of them, immutable once made. Every column is in the
/// grid's sorted order and either as long as the grid or, where stated, empty.
///
/// A point may move in a straight line while a snapshot lasts: `grid` and the columns hold its
/// start (A), the `end_` columns its end (B), empty when A = B.
struct SurfacePoints {
  /// The plane of the face that lies beyond an edge near the point.
  struct EdgePlane {
    Eigen::Vector3f normal =
        Eigen::Vector3f::Zero();  ///< outward, unit; between two planes, a mean
    float height = 0;             ///< of the point above the plane, m
    /// How much the edge counts: 0 to 1 where it is convex (solid below both planes), 0 to -1 for
    /// a crease (free above both). Crossing 0 removes the edge, so a change of kind has no jump.
    float share = 0;
  };

  /// Edges that points lie beside. `end` is as long as `start`, or empty: then it is as `start`.
  struct Edges {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};  ///< no edge: above every index

    std::vector<std::uint32_t> of_point;  ///< which one, or kNone; as long as the grid, or empty
    std::vector<EdgePlane> start;
    std::vector<EdgePlane> end;
  };

  /// Smooth segments of the surface, as preparation found them. Columns are in sorted order and all
  /// as long as the grid, or all empty: then the points are one segment, whose normals' signs
  /// agree.
  struct Segments {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};  ///< no segment: above every index

    std::vector<std::uint32_t> segment;  ///< of each point; kNone: on none, and without confidence
    std::vector<std::uint32_t> component;  ///< of each segment: signs agree within one
    std::vector<std::uint8_t> known;       ///< of each component, 1: its normals point outward
    std::vector<float> residual;  ///< rms distance of the segment's points from their plane, m

    [[nodiscard]] bool empty() const { return segment.empty(); }
  };

  Eigen::Vector3d origin =
      Eigen::Vector3d::Zero();  ///< world frame; grid points are relative to it, m
  CellGrid grid;
  std::vector<Eigen::Vector3f> normals;  ///< unit, or zero; empty: none (metaball only)
  std::vector<float> density_weights;    ///< a_i of docs/method.md 2.2
  std::vector<float> radii;              ///< R_i, m
  std::vector<float> confidences;        ///< c_i, 0-1
  Segments segments;
  std::vector<float> materials;  ///< 0-1; empty: all 1
  std::vector<float> presences;  ///< 0-1: the sensor's confidence in this point. Empty: all 1
  /// Red, green, blue, for those who draw; empty: unknown.
  std::vector<std::array<std::uint8_t, 3>> colors;
  std::vector<Eigen::Vector3f> end_positions;
  std::vector<Eigen::Vector3f> end_normals;
  std::vector<float> end_density_weights;
  std::vector<float> end_radii;
  std::vector<float> end_confidences;
  std::vector<float> end_presences;

  /// Edges and creases that stay sharp (FieldOptions::sharp_edges); of organised depth.
  Edges edges;

  /// From where all points were seen, on the side that their normals point to: the surface holds
  /// towards that eye alone. Points of components whose side is undecided hold from the side that
  /// the hand comes from. None: all do.
  std::optional<SurfaceEye> eye;

  Kernel kernel = Kernel::wyvill;  ///< that the density weights were made for

  std::vector<float> cell_reach;  ///< for each cell: how far its points reach out of its box
                                  ///< while they move from start to end, m
  double radius = 0;              ///< a typical R (median), m
  double smallest_radius = 0;     ///< smallest R_i, m

  [[nodiscard]] std::size_t size() const { return grid.size(); }
  [[nodiscard]] bool one_sided() const { return eye.has_value(); }

  /// Around the points and where they are going, m, world frame; empty where there are none.
  [[nodiscard]] Box bounds() const;
};

/// Fills `cell_reach`, `radius` and `smallest_radius` from the other columns, which must be whole.
void finish(SurfacePoints& points);

/// Are the columns whole, in range and finished? For those who get points from others.
/// @throws Error that names the column.
void check(const SurfacePoints& points);

}  // namespace palpate
