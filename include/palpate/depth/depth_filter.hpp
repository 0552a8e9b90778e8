#pragma once

#include <memory>
#include <optional>
#include <span>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/depth/filtered_depth.hpp"
#include "palpate/geometry/ball.hpp"

namespace palpate {

struct DepthFilterOptions {
  std::optional<NoiseModel> noise = {};  ///< unset: measured, and tracked from then on
  double normal_error = 0.0035;          ///< wanted error of normals, rad (theta: 0.2 degrees)
  int memory = 8;  ///< frames that a still block averages, and up to eight times as many where
                   ///< one frame's normal is worse than that; 1: every frame by itself
  double nearest = 0.1;  ///< depths outside nearest..farthest are not believed, m
  double farthest = 20;
};

/// From raw depth to points that are as good as the noise allows: the noise-sized fit of
/// nss_fast.md section 1, then the temporal filter of its section 3. One thread uses it. Once it
/// has seen frames of one size, it allocates nothing.
class DepthFilter {
 public:
  /// @throws Error when an option is out of range.
  explicit DepthFilter(const DepthFilterOptions& options = {});
  ~DepthFilter();
  DepthFilter(DepthFilter&&) noexcept;
  DepthFilter& operator=(DepthFilter&&) noexcept;

  /// Filters one frame; the answer is valid until the next call. Blocks inside one of the balls
  /// (world frame) are fitted, the others are plain.
  /// `T_world_sensor` is the sensor's pose at the stamp: what is remembered of earlier frames is
  /// warped into this view.
  /// @throws Error when size and depths disagree, the camera is none or has not 6 x 6 pixels.
  const FilteredDepth& filter(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor,
                              std::span<const Ball> fit_within);

  /// The same with every block fitted.
  const FilteredDepth& filter(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor);

  /// The last frame again, now with every block fitted; nullptr when there is none.
  const FilteredDepth* fit_all();

  /// Forgets earlier frames.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
