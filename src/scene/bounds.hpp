// Finds where a source has points.
#pragma once

#include <memory>

#include "palpate/geometry/shapes.hpp"
#include "palpate/scene/source.hpp"

namespace palpate {

/// Around a source's newest surface and what is there besides it, m, world frame; empty without a
/// surface. A large cloud's surface begins around the tools, and the rest follows.
[[nodiscard]] inline Box bounds_of(const Source& source) {
  const std::shared_ptr<const SurfacePoints> points = source.points();
  if (!points || points->size() == 0) return {};
  Box box = points->bounds();
  const std::shared_ptr<const PointCloud> rest = source.state().overview;
  for (std::size_t k = 0; rest && k < rest->size(); ++k) box.extend(rest->point(k));
  return box;
}

}  // namespace palpate
