#pragma once

#include "io/depth_image.hpp"

namespace palpate::io {

/// A 16-bit grey PNG. @throws Error for any other PNG and for damaged ones.
[[nodiscard]] DepthImage read_png(const Input& input);

}  // namespace palpate::io
