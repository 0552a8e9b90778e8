#pragma once

#include <Eigen/Core>
#include <vector>

#include "depth/depth_view.hpp"

namespace palpate::depth {

/// A square of pixels whose upper left one is (u, v).
struct NoiseWindow {
  int u = 0;
  int v = 0;
  int size = 0;  ///< pixels along a side
};

/// What a quadratic surface in inverse depth leaves of a window.
struct WindowResidual {
  bool usable = false;       ///< enough pixels are measured
  float z = 0;               ///< mean depth, m
  float variance = 0;        ///< of one pixel's residual, as depth, m^2
  float block_variance = 0;  ///< of the mean of 2x2 residuals, m^2
  float step = 0;            ///< smallest depth difference of neighbours that is not 0, m
};

/// Fits windows of up to kLargest pixels along a side.
class NoiseWindowFitter {
 public:
  static constexpr int kLargest = 40;

  NoiseWindowFitter();

  WindowResidual fit(const DepthView& frame, const NoiseWindow& window);

  /// Of the last window: residuals as depth, m, row by row, 0 at pixels that are not measured.
  [[nodiscard]] const std::vector<float>& residuals() const { return residuals_; }
  /// 1 where measured, else 0.
  [[nodiscard]] const std::vector<float>& mask() const { return mask_; }

 private:
  static constexpr int kTerms = 6;  // 1, u, v, u^2, uv, v^2
  using Terms = Eigen::Matrix<double, kTerms, 1>;

  void gather(const DepthView& frame, const NoiseWindow& window);
  void take_step(float z, float before);
  [[nodiscard]] Terms surface(int size) const;
  void subtract(const Terms& c, int size);
  [[nodiscard]] float block_variance(int size) const;

  std::vector<float> residuals_;
  std::vector<float> mask_;
  double reference_ = 0;  // inverse depth that residuals count from before the fit, 1/m
  double depth_sum_ = 0;
  int count_ = 0;
  float step_ = 0;
};

}  // namespace palpate::depth
