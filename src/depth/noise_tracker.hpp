#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// Depths in steps of a fourth of an octave from 0.1 m on: narrow enough that sigma(z) z0^2 / z^2
/// is the same all over a bin for sensors that match patterns.
inline constexpr int kNoiseBins = 32;  // to 26 m (derived)

[[nodiscard]] inline int noise_bin(double z) {
  return std::clamp(static_cast<int>(std::floor(4 * std::log2(z / 0.1))), 0, kNoiseBins - 1);
}

/// Noise measured at one depth.
struct NoiseSample {
  double z = 0;       ///< m
  double sigma = 0;   ///< m
  double weight = 0;  ///< how many windows or tiles show it
};

/// sigma(z) = s0 + s1 z + s2 z^2 through samples, robust against single wrong ones; relative errors
/// count. Fewer terms where the samples span little depth, `prior` times a factor where they span
/// next to none. Positive at all depths, and it neither vanishes before the nearest sample nor
/// falls behind the farthest. Keeps the prior's correlation. No samples: the prior.
[[nodiscard]] NoiseModel fit_noise_curve(std::span<const NoiseSample> samples,
                                         const NoiseModel& prior);

/// Residual of a quadratic fit to a square of values, in squares of their unit.
struct WindowNoise {
  float variance = 0;  ///< of one value; 0: they are too few, show no one surface, or do not vary
  /// Mean square of the four cubic terms' coefficients, orthonormal: the variance of one value if
  /// values err alone, and n_c times that where windows are much larger than what errs together.
  float power = 0;
  float mean = 0;  ///< of the surface
};

/// Fits quadratic surfaces to squares of one size, whatever up to a quarter of the values are.
class NoiseFit {
 public:
  /// `size`: values along a side, at most kLargest.
  explicit NoiseFit(int size);

  static constexpr int kLargest = 40;  ///< values; the largest of kNoiseSizes
  static constexpr int kTerms = 6;     ///< of a quadratic surface: 1, u, v, u^2, u v, v^2

  [[nodiscard]] int size() const { return size_; }

  /// `values`: row by row, NaN where there is none.
  WindowNoise fit(std::span<const float> values);

 private:
  static constexpr std::size_t kDegrees = 4;  // 0 to 3: the cubic terms give the power
  using Row = std::array<float, kLargest>;
  using Coefficients = std::array<std::array<float, kDegrees>, kDegrees>;  // by degrees in u, v

  void subtract(std::span<const float> values, const Coefficients& surface);
  [[nodiscard]] float typical_residual();
  [[nodiscard]] Coefficients project(float limit);

  int size_;
  std::array<Row, kDegrees> polynomials_{};  // orthonormal over the pixels of a row
  std::vector<float> residuals_;             // NaN where there is no value
  std::vector<float> sorted_;
  float reference_ = 0;  // that values count from
  int inside_ = 0;       // values whose residuals project() has found to be within its limit
  double squares_ = 0;   // of these
};

/// A square of pixels whose upper left one is (u, v).
struct NoiseWindow {
  std::size_t level = 0;  ///< sets the size: kNoiseSizes
  int u = 0;
  int v = 0;
};

/// Pixels along a side. Small windows see noise and little shape; where neighbours err together
/// they take noise for shape.
inline constexpr std::array<int, 3> kNoiseSizes{10, 20, 40};  // docs/method.md 6.2

/// Some 256 windows of each size, all over the image.
[[nodiscard]] std::vector<NoiseWindow> lay_noise_windows(int width, int height);

/// Noise measured in one window.
struct SeenNoise {
  std::size_t level = 0;
  float z = 0;        ///< m; 0: no surface
  WindowNoise noise;  ///< of depths, m^2; variance 0: less than what the sensor can resolve
};

/// Noise measured in all windows.
struct SurveyedNoise {
  std::vector<NoiseSample> samples;  ///< by depth; none: too little could be used
  double shared = 1;                 ///< n_c: over how many pixels the noise's correlation sums up
  bool whole = false;  ///< windows large enough to hold the correlation were among them
};

/// Finds the noise that windows have in common: shape, which some of them have besides, differs
/// from window to window.
class NoiseSurvey {
 public:
  void conclude(std::span<const SeenNoise> windows);

  [[nodiscard]] const SurveyedNoise& noise() const { return noise_; }

 private:
  /// Noise measured in windows of one size.
  struct Level {
    std::array<NoiseSample, kNoiseBins> bins{};  // weight 0: nothing
    double power = 0;  // of the cubic terms, over the variance; 0: none was measured

    /// Share of the noise that the fits have taken for shape.
    [[nodiscard]] double missing(int size) const;
  };

  void find_samples(std::span<const SeenNoise> windows, std::size_t level);
  void find_power(std::span<const SeenNoise> windows, std::size_t level);
  [[nodiscard]] double growth(std::size_t from, std::size_t to) const;
  [[nodiscard]] bool holds(std::size_t level) const;

  std::array<Level, kNoiseSizes.size()> levels_;
  std::vector<float> values_;
  SurveyedNoise noise_;
};

/// View of a depth image, which it does not own. Depths along the optical axis, m, row by row; what
/// is not within nearest ... farthest (0, NaN, infinity too) counts as not measured.
struct DepthView {
  std::span<const float> depth;
  int width = 0;      ///< pixels
  int height = 0;     ///< pixels
  double focal = 0;   ///< pixels
  float nearest = 0;  ///< m
  float farthest = 0;

  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)];
  }
  [[nodiscard]] bool valid(float z) const { return z >= nearest && z <= farthest; }
};

/// Follows a sensor's sigma(z) and c (docs/method.md 6.2) from frame to frame: by what quadratic
/// surfaces leave of windows in single frames, completed and bounded by differences of frames where
/// the scene stands still. The first frame shows all windows, later ones a share of them each. What
/// they do not give (too few pixels, all of one value) is taken from the prior. The model changes
/// only when the evidence has moved by a tenth, so that the fits of a still scene stay the same.
/// One thread uses it; it allocates only when the size of the frames changes.
class NoiseTracker {
 public:
  explicit NoiseTracker(const NoiseModel& prior);
  ~NoiseTracker();
  NoiseTracker(NoiseTracker&&) noexcept;
  NoiseTracker& operator=(NoiseTracker&&) noexcept;

  /// Looks at the next frame and returns what to take for it. A frame that repeats the one before
  /// changes nothing.
  const NoiseModel& update(const DepthView& frame);

  [[nodiscard]] const NoiseModel& model() const;

  /// Back to the prior.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::depth
