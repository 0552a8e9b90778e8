#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "depth/simd/fits.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::depth {

/// @throws Error when an option is out of range.
void check(const DepthFilterOptions& options);

/// Pixels across and down of three blocks: fewer give no slope (derived).
inline constexpr int kFewestPixels = 6;

/// Pixels across or down of an organised cloud; what has more does not come from a camera, and a
/// few points would take gigabytes. Twice as many as any depth camera has (judgement).
inline constexpr std::size_t kMostPixels = 8192;

/// @throws Error when the frame's size and depths disagree, its intrinsics are not valid, or it is
/// too small.
void check(const DepthFrame& frame);

/// @throws Error when the pose is not finite.
void check(const Eigen::Isometry3d& T_world_sensor);

/// Depth images as a lens without distortion would have taken them. Each pixel starts from the
/// nearest pixel of the distorted image and goes towards that one's neighbours, beside and below or
/// above, as far as it lies from it: in inverse depth, which is affine on planes. A neighbour
/// counts where it shows the same surface, so that nothing is ever mixed across a silhouette; and
/// where the nearest pixel shows nothing, nothing is shown.
///
/// The noise is that of the distorted image: of one pixel less than half of the variance is left,
/// but neighbours share what is left, and the mean over a window errs as if nothing had been done.
/// Measured before, sigma and c are right for fits, and high by a tenth for single blocks.
class Undistorter {
 public:
  /// The image without distortion: `depth` itself when the camera has none, else 0 where nothing
  /// in range was measured. Valid until the next call. Computes its map when the camera is another
  /// one than before.
  const float* undistort(const CameraModel& camera, const std::vector<float>& depth,
                         const NoiseModel& noise, const DepthFilterOptions& range);

 private:
  /// Pixels of the distorted image that one of the other comes from.
  struct Origin {
    std::int32_t nearest = -1;  // -1: outside
    std::int32_t beside = -1;
    std::int32_t below = -1;  // or above
    float across = 0;         // to the pixel beside, pixels: 0 to 0.5
    float down = 0;

    /// Depth at this position in the image, m; 0: nothing in range.
    [[nodiscard]] float depth_in(const float* image, const simd::DepthGate& gate) const;
  };

  [[nodiscard]] static Origin origin_of(const CameraModel& camera, int u, int v);
  void make_map(const CameraModel& camera);

  std::optional<CameraModel> camera_ = {};
  std::vector<Origin> map_;
  std::vector<float> image_;
};

/// Does the distorted radius grow from the middle of the image to the normalised image coordinates
/// x, y? From where it does not, the model means nothing.
[[nodiscard]] bool is_in_lens(const CameraModel::Distortion& distortion, double x, double y);

/// Normalised image coordinates.
struct ImagePoint {
  double x = 0;
  double y = 0;
};
/// Where a camera with `distortion` sees what is at x, y without it.
[[nodiscard]] ImagePoint distort(const CameraModel::Distortion& distortion, double x, double y);

}  // namespace palpate::depth
