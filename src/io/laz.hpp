#pragma once

#include <array>
#include <span>
#include <string>

#include "io/input.hpp"
#include "io/las_header.hpp"

namespace palpate::io {

/// Under what names the user's LASzip is looked for (as dlopen does).
inline const std::array<std::string, 2> kLaszipNames{"liblaszip.so.8", "liblaszip.so"};

/// LAZ (and COPC, which is LAZ), through the C interface of the user's LASzip 3 library.
/// @throws Error that says how to convert the file where none of `libraries` can be loaded.
[[nodiscard]] CloudFile read_laz(const Input& input, const LasHeader& header,
                                 std::span<const std::string> libraries = kLaszipNames);

}  // namespace palpate::io
