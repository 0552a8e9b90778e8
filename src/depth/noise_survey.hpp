#pragma once

#include <array>
#include <span>
#include <vector>

#include "depth/noise_fit.hpp"

namespace palpate::depth {

/// A square of pixels whose upper left one is (u, v).
struct NoiseWindow {
  std::size_t level = 0;  ///< says the size: kNoiseSizes
  int u = 0;
  int v = 0;
};

/// Pixels along a side. Small windows see noise and little shape; where neighbours err together
/// they take noise for shape.
inline constexpr std::array<int, 3> kNoiseSizes{10, 20, 40};

/// Some 256 windows of each size, all over the image.
[[nodiscard]] std::vector<NoiseWindow> lay_noise_windows(int width, int height);

/// What one window showed.
struct SeenNoise {
  std::size_t level = 0;
  float z = 0;        ///< m; 0: no surface
  WindowNoise noise;  ///< of depths, m^2; variance 0: less than what the sensor can tell
};

/// What all of them say.
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
  /// What windows of one size say.
  struct Level {
    std::array<NoiseSample, kNoiseBins> bins{};  // weight 0: nothing
    double power = 0;  // of the cubic terms, over the variance; 0: nothing is known

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

}  // namespace palpate::depth
