#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/depth/depth_filter.hpp"

namespace palpate {

/// Correlation of a simulated depth camera's errors from pixel to pixel. All kinds have the same
/// standard deviation.
enum class NoiseKind {
  none,         ///< exact depths, still rounded
  independent,  ///< in each pixel for itself
  blurred,      ///< white noise after a Gaussian blur of 2 pixels
  quantised,    ///< after one of 4 pixels, and then quantised in disparity, as the first Kinect
};

/// sigma(z) = 0.0012 + 0.0019 (z - 0.4)^2, in m: a Kinect-like camera's.
[[nodiscard]] NoiseModel kinect_like_noise();

struct SimulatedNoiseOptions {
  NoiseKind kind = NoiseKind::independent;
  NoiseModel model = kinect_like_noise();  ///< its standard deviation; `kind` sets the correlation
  double rounding = 1e-3;                  ///< depths are whole multiples of it, m; 0: not rounded
  bool silhouettes = false;  ///< of the pixels at depth jumps a quarter is missing and a quarter
                             ///< lies between the two depths (flying)
  std::uint64_t seed = 0;

  // Further faults, all off by default; docs/simulated_cameras.md lists which sensors have them.
  /// NoiseModel::correlation of the noise, and of the pattern, 0 or 1-30: white noise after a
  /// Gaussian blur of correlation / (2 sqrt(pi)) pixels. 0: `kind` sets it.
  double correlation = 0;
  /// Depths are means over a square of pixels with so many to each side, 0-15, of those that differ
  /// by less than 2 %: what phones and drivers' spatial filters do. After all else but holes.
  int smoothing = 0;
  /// Each frame is off as a whole: three in four not at all, one by up to this, m, 0-0.1.
  double hops = 0;
  /// Disparities are whole multiples of it after the noise, pixels of a camera with 525 pixels of
  /// focal length and 75 mm of base line, 0-8; each row is off by up to a quarter of it before they
  /// are rounded, by the same in all frames.
  double disparity_step = 0;
  /// The nearer side of a depth jump goes on over 1 to 3 pixels of the farther one, the same ones
  /// in all frames, and bends away from the camera from 3 pixels before the jump on, to the square,
  /// by so much 3 pixels behind it, m, -0.1 to 0.1; < 0: towards the camera. Silhouettes then
  /// disturb the farther side alone.
  double curl = 0;
  /// Pixels gather light over a Gaussian of this deviation, pixels, 0-1: those at depth jumps
  /// report the mean of the depths of 3 x 3 pixels, weighed with it and with 1 / z^2.
  double mixed = 0;
  double pattern = 0;  ///< deviation of an error that each pixel has in all frames, m, 0-0.1
  /// Share of pixels in holes, 0-0.9: discs 3 to 12 pixels wide, each there for 2 to 8 frames.
  double holes = 0;
};

/// Makes what a sensor would have measured of exact depths. The same options, frame number and
/// depths give the same result everywhere. One thread uses it; it allocates in its first frame
/// only.
class SimulatedNoise {
 public:
  /// @throws Error when an option is out of its range.
  explicit SimulatedNoise(const SimulatedNoiseOptions& options);

  /// Disturbs `depth` (m, `width` * `height`, row by row; 0 stays 0) as frame number `frame`.
  void apply(int width, int height, std::uint64_t frame, std::vector<float>& depth);

  /// Noise of variance 1 as `kind` correlates it; zeros for `none`. Valid until the next call.
  const std::vector<float>& unit_noise(int width, int height, std::uint64_t frame);

  [[nodiscard]] const SimulatedNoiseOptions& options() const { return options_; }

 private:
  void disturb_rims(int width, int height, std::uint64_t frame, std::vector<float>& depth);
  void add_pattern(int width, int height, std::vector<float>& depth);
  void draw(std::uint64_t seed);
  void blur(int width, int height);
  void smooth(int width, int height, std::vector<float>& depth);

  SimulatedNoiseOptions options_;
  std::vector<float> quantiles_;  // of the normal distribution, evenly spaced in probability
  std::vector<float> taps_;       // half of the blur's, its middle first
  std::vector<float> noise_;
  std::vector<float> row_;
  std::vector<float> padded_;  // the image with its other side above and below
  std::vector<float> exact_;
  std::vector<float> pattern_;
};

}  // namespace palpate

namespace palpate::sim {

/// Depths (m, row by row, 0: none) to look at.
struct DepthView {
  int width;
  int height;
  const float* depth;

  [[nodiscard]] bool inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < width && v < height;
  }
  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * width + u];
  }
};

// Apply the faults of SimulatedNoiseOptions, from `exact` into its copy `depth`.
void bend_rims(const DepthView& exact, const SimulatedNoiseOptions& options, float* depth);
void mix_rims(const DepthView& exact, const SimulatedNoiseOptions& options, float* depth);
void disturb_silhouettes(const DepthView& exact, std::uint64_t seed, bool far_side, float* depth);
void punch_holes(const DepthView& exact, const SimulatedNoiseOptions& options, std::uint64_t frame,
                 float* depth);

}  // namespace palpate::sim
