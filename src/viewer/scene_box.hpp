#pragma once

#include "palpate/geometry/shapes.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::viewer {

/// Around the points of every source's newest surface; empty where there are none. Any thread but a
/// servo's.
[[nodiscard]] Box scene_box(const Scene& scene);

}  // namespace palpate::viewer
