#pragma once

#include "io/depth_image.hpp"

namespace palpate::io {

/// Do the samples make a smoother picture with their bytes exchanged? Surfaces are smooth, and a
/// swapped image jumps from pixel to pixel by what should be its fine steps.
[[nodiscard]] bool looks_swapped(const DepthImage& image);

/// Exchanges the bytes of every sample.
void swap_bytes(DepthImage& image);

}  // namespace palpate::io
