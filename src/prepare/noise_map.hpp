#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// How noisy a cloud is where: sensors err more on what is far away or faces them.
class NoiseMap {
 public:
  /// `raw`: the points as measured, `spacings` theirs, in sorted order, m.
  NoiseMap(const CellGrid& raw, std::span<const float> spacings);

  /// sigma_n delta for each of `points`, m^2: rms distance from a smooth surface times the root of
  /// the area per point, as the flatter part of the surroundings has it, so that edges are no
  /// noise.
  [[nodiscard]] std::vector<float> at(std::span<const Eigen::Vector3f> points) const;

 private:
  CellGrid places_;
  std::vector<float> values_;  // sigma_n delta, in the order of places_
  float reach_ = 0;            // how far a value is of interest, m
  float typical_ = 0;
};

}  // namespace palpate
