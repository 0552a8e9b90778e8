#pragma once

#include "io/input.hpp"

namespace palpate::io {

/// LAS 1.0 - 1.4, point formats 0 - 10. Points marked withheld are dropped; intensity and colour
/// are kept unless they are zero throughout. Made for tens of millions of points: two passes over
/// the bytes, nothing held twice. A compressed (LAZ) file goes to read_laz.
[[nodiscard]] CloudFile read_las(const Input& input);

}  // namespace palpate::io
