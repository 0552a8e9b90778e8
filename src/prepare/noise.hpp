// The noise of a cloud: of all, and locally.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/prepare/cloud_facts.hpp"

namespace palpate {

/// A window shows a layer of noise as a layer, and not as a ball full of points, where its reach is
/// at least this many sigma.
inline constexpr double kSigmasInReach = 4;

/// Measures it on a sample of the points. `spacing`: of the points, m. `spacings`: that narrow
/// windows are multiples of, at each point, m, in sorted order; on lines how far these are apart,
/// so that a window holds several.
///
/// Noise that neighbours share (a depth camera's, mostly) is mistaken for shape in narrow windows
/// and does not average out as fast as its variance suggests. Wide windows measure it, as long as
/// they see noise and no shape: on the flattest of them the residuals no longer grow with the
/// window (docs/method.md 5.2).
[[nodiscard]] Noise measure_noise(const CellGrid& grid, double spacing,
                                  std::span<const float> spacings);

/// The noise at each point, in sorted order.
struct LocalNoise {
  std::vector<float> sigmas;    ///< rms distance from a smooth surface, m
  std::vector<float> products;  ///< sigma_n delta, m^2: that times the root of the area per point
};

/// How noisy a cloud is where: sensors err more on what is far away or faces them.
class NoiseMap {
 public:
  /// `raw`: the points as measured, `spacings` theirs, in sorted order, m.
  NoiseMap(const CellGrid& raw, std::span<const float> spacings);

  /// At each of `points`, as the flatter part of the surroundings has it, so that edges are no
  /// noise; made larger by what neighbours share in the `whole` cloud.
  [[nodiscard]] LocalNoise at(std::span<const Eigen::Vector3f> points, const Noise& whole) const;

 private:
  struct Value {
    float sigma = 0;    // m
    float product = 0;  // sigma_n delta, m^2
  };

  [[nodiscard]] Value at(const Eigen::Vector3f& point, std::vector<std::uint32_t>& near,
                         std::vector<float>& around) const;

  CellGrid positions_;
  std::vector<Value> values_;  // in the order of positions_
  float reach_ = 0;            // how far a value is of interest, m
  Value typical_;
};

}  // namespace palpate
