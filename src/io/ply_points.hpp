// Reads the points of PLY files, whatever else these hold.
#pragma once

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/ply_rows.hpp"

namespace palpate::io {

/// What the properties of an element with points are.
struct PlyVertices {
  Roles roles;  ///< one a property
  ColorScale color_scale = ColorScale::byte;
};

[[nodiscard]] PlyVertices columns_of(const PlyElement& element);

/// The first element that has x, y and z.
/// @throws Error when none has.
[[nodiscard]] const PlyElement& points_of(const Input& input, const PlyHeader& header);

/// The table of an element whose properties have these roles, a row of it in their order.
[[nodiscard]] PlyTable table_of_points(const PlyElement& element, const Roles& roles);

/// The points alone: faces are passed over, and splats are points as others.
/// @throws Error as read_ply() does.
[[nodiscard]] CloudFile read_ply_points(const Input& input);

}  // namespace palpate::io
