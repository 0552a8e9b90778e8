#pragma once

#include "io/formats.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// The input in the unit that a LAS file states by its GeoTIFF keys or its well-known text.
/// @throws Error for one that declares its coordinates as degrees, in which nothing has a shape.
[[nodiscard]] Input in_las_unit(const Input& input, const LasHeader& header);

/// Throws the Error for coordinates that are degrees.
[[noreturn]] void fail_as_degrees(const Input& input);

}  // namespace palpate::io
