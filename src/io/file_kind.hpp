#pragma once

#include "io/input.hpp"

namespace palpate::io {

enum class FileKind { ply, pcd, las, obj, text, png, pgm, gzip };

/// What the bytes are: by their first bytes, for text also by its first words, and by the name
/// last.
/// @throws Error that says what to do about kinds that we know but do not read (xz, JPEG, E57, STL,
///   JSON, a web page, ...) and about bytes that are nothing we know.
[[nodiscard]] FileKind kind_of(const Input& input);

}  // namespace palpate::io
