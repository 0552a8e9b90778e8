// Reads depth images of Python.
#include "images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "arrays.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate::python {

void take_image(const pybind11::array& image, Camera& camera) {
  const auto count = static_cast<std::size_t>(image.size());
  camera.frame.camera = camera.model;
  camera.frame.depth.resize(count);
  if (image.itemsize() == kFloat32.bytes) {
    const auto* const depth = static_cast<const float*>(image.data());
    std::copy(depth, depth + count, camera.frame.depth.begin());
  } else {
    to_metres({static_cast<const std::uint16_t*>(image.data()), count}, camera.unit,
              camera.frame.depth);
  }
}

std::string problem_of(const Camera& camera, bool whole) {
  const DepthFilterOptions& range = camera.range;
  std::vector<float> far;
  for (const float z : camera.frame.depth) {
    if (static_cast<double>(z) >= range.nearest && static_cast<double>(z) <= range.farthest) {
      return {};
    }
    if (z > 0 && std::isfinite(z)) far.push_back(z);
  }
  if (far.empty()) return {};
  return fmt::format(
      "all depths of the image at {} s are nearer than {} m or farther than {} m (median {:.4g} "
      "m); "
      "give {}, or other nearest= and farthest= to add_camera()",
      camera.frame.stamp, range.nearest, range.farthest, median(far),
      whole ? fmt::format("another unit= to add_camera() than {} m a step", camera.unit)
            : "real numbers in metres, such as depth * np.float32(0.001) of millimetres");
}

}  // namespace palpate::python
