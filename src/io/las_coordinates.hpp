#pragma once

#include <string_view>

#include "io/formats.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// @throws Error for a LAS file that declares its coordinates as degrees, in which nothing has a
/// shape.
void check_no_degrees(const Input& input, const LasHeader& header);

/// The unit that a LAS file states, as its format is described to people: ", in metres",
/// ", in feet", or nothing where it states none, or another.
[[nodiscard]] std::string_view stated_unit(const Input& input, const LasHeader& header);

}  // namespace palpate::io
