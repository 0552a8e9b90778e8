#pragma once

#include "io/file_bytes.hpp"
#include "io/input.hpp"

namespace palpate::io {

/// The bytes inside gzip (one member or several in a row). Refuses what grows beyond any honest
/// cloud: more than 64 MiB and more than 250 times the packed size.
/// @throws Error for broken, cut or oversized data.
[[nodiscard]] Bytes gunzip(const Input& input);

}  // namespace palpate::io
