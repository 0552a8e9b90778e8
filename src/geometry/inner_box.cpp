// Finds the box of a cloud without its outermost points.
#include "geometry/inner_box.hpp"

#include <algorithm>
#include <vector>

namespace palpate::detail {

Box inner_box(std::span<const Eigen::Vector3f> points, std::size_t outermost) {
  std::vector<float> values(points.size());
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(outermost);
  const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(outermost);
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points, values.begin(),
                           [&](const Eigen::Vector3f& p) { return p[axis]; });
    std::ranges::nth_element(values, low);
    box.lower[axis] = static_cast<double>(*low);
    std::ranges::nth_element(values, high);
    box.upper[axis] = static_cast<double>(*high);
  }
  return box;
}

}  // namespace palpate::detail
