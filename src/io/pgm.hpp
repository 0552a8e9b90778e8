#pragma once

#include "io/depth_image.hpp"

namespace palpate::io {

/// A binary PGM ("P5") with a largest value above 255: two bytes a pixel, the more significant
/// first, as its specification has it.
[[nodiscard]] DepthImage read_pgm(const Input& input);

}  // namespace palpate::io
