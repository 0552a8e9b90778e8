#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "depth/noise_bins.hpp"
#include "depth/noise_correlation.hpp"
#include "depth/noise_windows.hpp"

namespace palpate::depth {

/// Windows of one size all over an image: which of them are flat but for noise, and how noisy
/// those are at which depth.
class NoiseLevel {
 public:
  NoiseLevel(int size, int stride, int reach);

  /// Lays windows over an image of this size; takes memory when there are more than ever.
  void resize(int width, int height);
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] std::size_t windows() const { return windows_.size(); }

  void measure(const DepthView& frame, std::size_t window, NoiseWindowFitter& fitter);
  /// When all windows are measured: finds the flat ones, and chooses some to be correlated.
  void find_flat();
  [[nodiscard]] std::size_t chosen() const { return chosen_.size(); }
  /// Takes one of the chosen windows into the correlation, if the frame still shows it flat.
  void correlate(const DepthView& frame, std::size_t chosen, NoiseWindowFitter& fitter);

  [[nodiscard]] const std::vector<WindowResidual>& residuals() const { return residuals_; }
  /// By depth; of the flat windows, without the correction that their correlation asks for.
  [[nodiscard]] const std::vector<NoiseSample>& samples() const { return samples_; }
  [[nodiscard]] NoiseCorrelation correlation() const { return sum_.correlation(); }
  [[nodiscard]] int correlated() const { return sum_.windows(); }

 private:
  void find_flat(int bin);
  [[nodiscard]] bool is_flat(const WindowResidual& residual) const;

  int size_ = 0;
  int stride_ = 0;
  CorrelationSum sum_;
  std::vector<NoiseWindow> windows_;
  std::vector<WindowResidual> residuals_;
  std::vector<float> variances_;  // of one bin
  std::vector<float> steps_;
  std::array<NoiseSample, kNoiseBins> bins_{};
  std::vector<NoiseSample> samples_;
  std::vector<std::uint32_t> chosen_;
};

}  // namespace palpate::depth
