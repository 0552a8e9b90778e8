#pragma once

#include "io/input.hpp"

namespace palpate::io {

/// The vertices of a Wavefront OBJ file ("v x y z", with "r g b" where the first vertex has them),
/// and its normals where there are as many "vn" as "v". Everything else is skipped.
[[nodiscard]] CloudFile read_obj(const Input& input);

}  // namespace palpate::io
