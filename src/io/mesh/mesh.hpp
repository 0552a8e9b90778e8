#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/cloud_builder.hpp"
#include "io/input.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

/// x, y, z in the file's unit; red, green, blue; intensity.
using MeshVertex = Eigen::Matrix<double, 7, 1>;

[[nodiscard]] MeshVertex mesh_vertex(const Row& row);

/// Faces of a file: polygons, mostly triangles, whose corners are vertices.
struct Mesh {
  std::vector<MeshVertex> vertices{};
  std::vector<std::uint32_t> corners{};  ///< indices of vertices, face after face
  std::vector<std::size_t> ends{};       ///< where each face ends in `corners`
  Columns columns{};                     ///< colours and intensities that vertices have
  ColorScale color_scale = ColorScale::byte;
  bool has_unit = true;  ///< false: the format has none

  /// The next vertex becomes a corner of the face that close_face() ends.
  void add_corner(std::size_t vertex) { corners.push_back(static_cast<std::uint32_t>(vertex)); }
  void close_face() { ends.push_back(corners.size()); }
  void add_triangle(std::size_t a, std::size_t b, std::size_t c);

  [[nodiscard]] std::span<const std::uint32_t> face(std::size_t i) const;
};

/// Points sampled from the faces (docs/formats.md, "Meshes"), each with the normal of its face and
/// colours and intensities in between those of the corners.
/// @throws Error when no face has an area.
[[nodiscard]] CloudFile sample_faces(const Input& input, const Mesh& mesh, std::string format);

/// The cloud of a file that has points of its own: `vertices`, unless there are faces that
/// describe more.
[[nodiscard]] CloudFile choose_cloud(const Input& input, const Mesh& mesh, CloudFile vertices);

}  // namespace palpate::io
