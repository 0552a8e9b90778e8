#pragma once

#include <OniCTypes.h>

#include <vector>

namespace palpate::sensor {

/// Does it hold all depths that it says, in a format that is known?
[[nodiscard]] bool is_whole(const OniFrame& image);

/// Depths (m, row by row, reusing memory) of a frame that is whole; `mirrored`: left is right.
void copy_depth(const OniFrame& image, bool mirrored, std::vector<float>& depth);

}  // namespace palpate::sensor
