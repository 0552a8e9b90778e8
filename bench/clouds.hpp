#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace palpate::bench {

/// Points on a bumpy, noisy sphere of 0.1 m, spread evenly and in no order: the cloud of the speed
/// tables. Noise is a tenth of the spacing. The same for the same count, always.
[[nodiscard]] std::vector<Eigen::Vector3f> bumpy_sphere(std::size_t count);

/// Root of the area per point of that cloud, m.
[[nodiscard]] double bumpy_sphere_spacing(std::size_t count);

}  // namespace palpate::bench
