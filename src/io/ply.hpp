#pragma once

#include "io/input.hpp"

namespace palpate::io {

/// PLY: ascii, binary little and big endian; any order and type of properties. Points are the
/// first element that has x, y and z; other elements and lists are skipped. Kept of a point: its
/// normal, colour and the first scalar whose name says intensity or quality.
[[nodiscard]] CloudFile read_ply(const Input& input);

}  // namespace palpate::io
