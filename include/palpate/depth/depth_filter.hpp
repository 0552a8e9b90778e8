#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// Noise of a depth camera: sigma(z) = s0 + s1 z + s2 z^2 along the optical axis for one pixel, and
/// the correlation of neighbouring pixels.
struct NoiseModel {
  std::array<double, 3> coefficients{};  ///< s0 (m), s1, s2 (1/m)
  /// c: error of the mean of many neighbouring pixels over what independent pixels would have;
  /// >= 1. Its square is the sum of the noise's autocorrelation, in pixels.
  double correlation = 1;

  [[nodiscard]] double sigma(double z) const {
    return coefficients[0] + z * (coefficients[1] + z * coefficients[2]);
  }
};

/// Noise assumed before the first frame for a kind of sensor: kinect1, xtion, realsense or tof.
/// Measured on recordings (docs/method.md 6.2).
/// @throws Error that lists the names when it is none of them.
[[nodiscard]] NoiseModel sensor_noise(std::string_view sensor);

/// For an unknown sensor: as noisy as the worse of the common ones within a
/// metre, so that a fit smooths too much rather than too little.
[[nodiscard]] NoiseModel unknown_sensor_noise();

/// The tiles of 4x4 blocks of which a filter's answer is what the one before was.
struct KeptTiles {
  /// Blocks. Few tiles see a rim, and the mean of one is about four times as precise as a block.
  static constexpr int kSide = 4;
  static constexpr int kTogether = 64;  ///< blocks (judgement)

  int columns = 0;                  ///< of blocks
  std::vector<std::uint8_t> flags;  ///< of tiles, row by row: 1 if it is kept; none: none is

  [[nodiscard]] std::size_t index(int column, int row) const {
    const int tiles = (columns + kSide - 1) / kSide;
    return static_cast<std::size_t>(row / kSide) * tiles + column / kSide;
  }
  [[nodiscard]] bool at(int column, int row) const {
    return !flags.empty() && flags[index(column, row)] != 0;
  }

  /// Calls take(first, count) for the blocks of a row that are not kept, at most kTogether at once.
  template <class Take>
  void each_other(int row, const Take& take) const {
    for (int first = 0, end = 0; first < columns; first = end) {
      while (end < columns && end < first + kTogether && !at(end, row)) end += kSide;
      if (end > first) {
        take(first, std::min(end, columns) - first);
      } else {
        end += kSide;
      }
    }
  }
};

/// A depth frame made into points, one a block of 2x2 pixels, row by row. A block's number is its
/// points' identity from frame to frame as long as the camera stands still. All columns have
/// columns * rows entries; those of empty blocks mean nothing.
struct FilteredDepth {
  /// State of one 2x2 block of pixels.
  enum class State : std::uint8_t {
    empty,   ///< nothing measured, or rejected (flying pixels)
    plain,   ///< mean of its pixels, normal from its neighbours: outside the region to be fitted
    fitted,  ///< position and normal from the noise-sized fit
  };

  double stamp = 0;                                                  ///< of the frame, s
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();  ///< at the stamp
  int columns = 0;                                                   ///< of blocks
  int rows = 0;
  double pitch = 0;  ///< angle between blocks: metres between blocks for one metre of depth
  std::vector<State> states;
  std::vector<Eigen::Vector3f> positions;  ///< sensor frame, m
  std::vector<Eigen::Vector3f> normals;    ///< sensor frame, unit, towards the sensor; zero: none
  std::vector<float> confidences;          ///< c_i of the normals, 0-1
  std::vector<float> deviations;           ///< sd of the position along the ray, m
  std::vector<float> spacings;  ///< s_i: largest distance to a neighbouring block's point
                                ///< on the same surface, m (grazing rows are far apart)
  NoiseModel noise;             ///< in use for this frame
  bool duplicate = false;       ///< the frame repeats the one before, bit for bit
  KeptTiles kept;               ///< what was not filtered again, since it shows what it showed

  [[nodiscard]] std::size_t size() const { return states.size(); }
};

struct DepthFilterOptions {
  std::optional<NoiseModel> noise = {};  ///< unset: measured, and tracked from then on
  double normal_error = 0.0035;          ///< wanted error of normals, rad (theta: 0.2 degrees)
  int memory = 8;  ///< frames that a still block averages, and up to eight times as many where
                   ///< one frame's normal is worse than that; 1: every frame by itself
  double nearest = 0.1;  ///< depths outside nearest..farthest are not believed, m
  double farthest = 20;
};

/// Turns raw depths into points as good as the noise allows: by the noise-sized fit, then the
/// filter over time (docs/method.md 6.3 to 6.6). One thread uses it. Once it has seen frames of one
/// size, it allocates nothing.
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
  /// @throws Error when size and depths disagree, the camera's intrinsics are not valid, or it has
  /// less than 6 x 6 pixels.
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
