#pragma once

#include "io/input.hpp"

namespace palpate::io {

/// PCD 0.5 - 0.7: ascii, binary and binary_compressed; organised or not. Kept of a point: normal,
/// colour ("rgb", "rgba": 0x00rrggbb in the bits of a float or an integer) and intensity. The
/// viewpoint is kept when the cloud is organised or the file sets one.
[[nodiscard]] CloudFile read_pcd(const Input& input);

}  // namespace palpate::io
