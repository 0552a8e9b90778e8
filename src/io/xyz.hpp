#pragma once

#include "io/input.hpp"

namespace palpate::io {

/// A point a line, numbers separated by blanks, tabs, commas or semicolons. Lines that start with
/// #, // or % are comments; a first line of one whole number announces a count (PTS).
///
/// A header line names the columns. Without one their number decides: 3 x y z; 4 and an
/// intensity; 6 and a normal if the last three have unit length in the first lines, else a colour;
/// 7 intensity and colour; 9 and a normal and a colour, in the order in which unit length is found.
/// Of other numbers the first three columns are used.
[[nodiscard]] CloudFile read_xyz(const Input& input);

}  // namespace palpate::io
