#pragma once

#include <string>

#include "io/input.hpp"
#include "io/mesh/mesh.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

/// The faces as triangles: of each polygon those from one of its corners, if they cover it.
/// @throws Error without faces, and for a polygon that they cover from none of its corners.
[[nodiscard]] TriangleMesh triangles_of(const Input& input, const Mesh& mesh, std::string format);

}  // namespace palpate::io
