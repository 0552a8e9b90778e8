#pragma once

#include "accuracy/rows.hpp"

/// The single strokes that rows of table A consist of.
namespace palpate::accuracy {

inline constexpr double kSlideDepth = 3e-3;  ///< m; derived: table A
inline constexpr double kLightDepth = 5e-4;  ///< m; derived: table A
/// m above the surface, where paths begin and end; judgement
inline constexpr double kPathClearance = 0.01;

/// Along one straight line at constant depth (m) below a plane of the given outward normal.
[[nodiscard]] Path slide(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                         const Eigen::Vector3d& normal, double depth);

/// The same over the middle of a half-space, `length` long (m), `turn` from its x (rad).
[[nodiscard]] Path slide_over(const Solid& half_space, double turn, double length, double depth);

/// A part of a great circle: its middle, its direction there (unit vectors) and half of it, rad.
struct Arc {
  Eigen::Vector3d middle;
  Eigen::Vector3d side;
  double half = 0;
};

/// Outward, where the share t of the arc is behind.
[[nodiscard]] Eigen::Vector3d direction_on(const Arc& arc, double t);

/// There and back over an arc of the sphere.
[[nodiscard]] Path sphere_arc(const Solid& sphere, const Arc& arc);

/// 1 m/s to 10 mm below a place of the table, where it stays for 0.1 s.
[[nodiscard]] Path tap(const Eigen::Vector3d& place);

/// 3 mm below a place of the table.
[[nodiscard]] Path static_press(const Eigen::Vector3d& place);

/// 30 mm past the plate's face at `from`, then to `to`: both in the plate's face, m.
[[nodiscard]] Path thin_push(const Solid& plate, const Eigen::Vector2d& from,
                             const Eigen::Vector2d& to);

/// An upright face of the box.
struct Face {
  Eigen::Vector3d top;     ///< middle of its upper edge, m, world
  Eigen::Vector3d foot;    ///< middle of its lower edge, on the table
  Eigen::Vector3d normal;  ///< outward
  Eigen::Vector3d along;   ///< horizontal, along the edges
  double half = 0;         ///< of its width, m
};

/// The face towards the box's own axis 0 (x) or 1 (y), times the sign.
[[nodiscard]] Face face_of(const Solid& box, int axis, double sign);

/// `depth` (m) into the table and as much into the box at once, along the foot between two places,
/// told by how far they are from its middle along the face (m), and out.
[[nodiscard]] Path crease(const Face& face, double depth, double from, double to);

/// Where the middle column of pixels sees the table last, at the image's lower border.
[[nodiscard]] Eigen::Vector3d cloud_edge(const TruthScene& scene);

/// The three rows at the edge of the cloud, where the truth goes on: what they tell of is steps,
/// the largest force and energy.
[[nodiscard]] std::vector<Row> edge_rows(const TruthScene& scene);

/// Is it one of these?
[[nodiscard]] bool is_edge_row(const std::string& name);

}  // namespace palpate::accuracy
