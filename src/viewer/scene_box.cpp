#include "viewer/scene_box.hpp"

#include <memory>

#include "palpate/field/surface_points.hpp"

namespace palpate::viewer {

Box scene_box(const Scene& scene) {
  Box box;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> points = scene.source(i).points();
    if (!points || points->grid.cells().empty()) continue;
    const CellGrid::Cell& root = points->grid.cells().front();
    box.extend(points->origin + root.lower.cast<double>());
    box.extend(points->origin + root.upper.cast<double>());
  }
  return box;
}

}  // namespace palpate::viewer
