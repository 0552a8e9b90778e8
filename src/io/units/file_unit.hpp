#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/input.hpp"
#include "io/units/stated_units.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::io {

/// An input in the unit that its file states, which `words` tell, unless the caller gave one.
[[nodiscard]] Input in_stated_unit(Input input, const StatedUnits& stated, std::string words);

/// The same where lines of a text that begin with `mark`, such as "#", state it, or name a program
/// that writes metres alone. Only the first thousand are looked at.
[[nodiscard]] Input in_unit_of_comments(const Input& input, std::string_view text,
                                        std::string_view mark);

/// The unit of faces that fill such a box, in a file that states none: millimetres where they could
/// be a part of a machine, whose longest side is 1 to 2000 of them; else metres, as in surveys.
[[nodiscard]] FileUnit likely_unit(const Box& box);

/// Do coordinates lie as far from their origin as those of surveys do?
[[nodiscard]] bool is_survey(const Box& box);

/// Does the file state the unit of z alone? That of x and y is assumed then.
[[nodiscard]] bool states_heights_alone(const FileUnit& unit);

/// m, the next unit of x and y to try then.
[[nodiscard]] double other_plan(const FileUnit& unit);

/// What a unit adds to the description of a format: ", in feet", ", taken as millimetres".
[[nodiscard]] std::string words_of(const FileUnit& unit);

}  // namespace palpate::io
