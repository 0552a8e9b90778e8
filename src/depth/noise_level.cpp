#include "depth/noise_level.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

constexpr std::size_t kFewest = 4;       // windows that make a sample
constexpr float kMoreThanLowest = 1.6F;  // variances up to this times the typical one are noise
constexpr int kTypicalRounds = 4;        // of finding the typical one
constexpr double kScattered = 0.25;      // share below 1 / kMoreThanLowest that only shape makes
constexpr std::size_t kChosen = 48;      // windows to be correlated
constexpr double kMostWeight = 60;
constexpr double kRounded = 0.02;  // of a step: residuals that rounding to it leaves at least
constexpr double kFinest = 1e-4;   // of the depth: no depth camera errs less

float quarter(std::vector<float>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

float median(std::vector<float>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The mean of the variances that belong together at the low end; shape, which some of the windows
// have besides, only adds.
float typical_variance(std::vector<float>& variances) {
  float typical = quarter(variances);
  for (int round = 0; round < kTypicalRounds; ++round) {
    double sum = 0;
    int count = 0;
    for (const float v : variances) {
      if (v > kMoreThanLowest * typical) continue;
      sum += v;
      ++count;
    }
    typical = static_cast<float>(sum / count);
  }
  return typical;
}

// The depth that a bin's variances are brought to.
double bin_depth(int bin) {
  return 0.1 * std::exp2((bin + 0.5) / 4);
}

double to_bin_depth(double z) {
  const double ratio = bin_depth(noise_bin(z)) / z;
  return ratio * ratio;
}

}  // namespace

NoiseLevel::NoiseLevel(int size, int stride, int reach)
    : size_(size), stride_(stride), sum_(size, reach) {
  samples_.reserve(kNoiseBins);
  chosen_.reserve(kChosen);
}

void NoiseLevel::resize(int width, int height) {
  windows_.clear();
  for (int v = 0; v + size_ <= height; v += stride_) {
    for (int u = 0; u + size_ <= width; u += stride_) windows_.push_back({u, v, size_});
  }
  residuals_.assign(windows_.size(), {});
  variances_.reserve(windows_.size());
  steps_.reserve(windows_.size());
  samples_.clear();
  chosen_.clear();
  sum_.clear();
}

void NoiseLevel::measure(const DepthView& frame, std::size_t window, NoiseWindowFitter& fitter) {
  residuals_[window] = fitter.fit(frame, windows_[window]);
}

// Windows of one value alone tell nothing: their noise is below the sensor's step or they are no
// measurement at all.
void NoiseLevel::find_flat(int bin) {
  variances_.clear();
  steps_.clear();
  double depths = 0;
  for (const WindowResidual& r : residuals_) {
    if (!r.usable || r.step <= 0 || noise_bin(r.z) != bin) continue;
    const double finest = kFinest * r.z;
    const double variance = std::max<double>(r.variance, finest * finest);
    variances_.push_back(static_cast<float>(variance * to_bin_depth(r.z)));
    const double seen = kRounded * r.step;
    steps_.push_back(r.variance > seen * seen ? r.step : 0.0F);
    depths += r.z;
  }
  NoiseSample& sample = bins_[static_cast<std::size_t>(bin)];
  sample = {};
  if (variances_.size() < kFewest) return;
  const float typical = typical_variance(variances_);
  const auto up_to = [this](float limit) {
    return static_cast<double>(std::count_if(variances_.begin(), variances_.end(),
                                             [limit](float v) { return v <= limit; }));
  };
  const double flat = up_to(kMoreThanLowest * typical);
  if (up_to(typical / kMoreThanLowest) > kScattered * flat) return;
  const double z = depths / static_cast<double>(variances_.size());
  const double rounding = median(steps_) / std::sqrt(12.0);
  const double sigma = std::sqrt(typical) * z / bin_depth(bin);
  sample = {z, std::max(sigma, rounding), std::min(flat, kMostWeight)};
}

bool NoiseLevel::is_flat(const WindowResidual& residual) const {
  if (!residual.usable || residual.step <= 0) return false;
  const NoiseSample& sample = bins_[static_cast<std::size_t>(noise_bin(residual.z))];
  const double sigma = sample.sigma * residual.z / std::max(sample.z, 1e-9);
  return sample.weight > 0 && residual.variance <= kMoreThanLowest * sigma * sigma;
}

void NoiseLevel::find_flat() {
  samples_.clear();
  chosen_.clear();
  sum_.clear();
  for (int bin = 0; bin < kNoiseBins; ++bin) {
    find_flat(bin);
    const NoiseSample& sample = bins_[static_cast<std::size_t>(bin)];
    if (sample.weight > 0) samples_.push_back(sample);
  }
  const auto flat = static_cast<std::size_t>(
      std::count_if(residuals_.begin(), residuals_.end(),
                    [this](const WindowResidual& r) { return is_flat(r); }));
  // Every so many-th, so that they come from all over the image.
  const std::size_t step = std::max<std::size_t>(1, (flat + kChosen - 1) / kChosen);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < residuals_.size(); ++i) {
    if (!is_flat(residuals_[i])) continue;
    if (seen++ % step == step / 2) chosen_.push_back(static_cast<std::uint32_t>(i));
  }
}

void NoiseLevel::correlate(const DepthView& frame, std::size_t chosen, NoiseWindowFitter& fitter) {
  const WindowResidual residual = fitter.fit(frame, windows_[chosen_[chosen]]);
  if (!is_flat(residual)) return;
  const NoiseSample& sample = bins_[static_cast<std::size_t>(noise_bin(residual.z))];
  sum_.add(fitter.residuals(), fitter.mask(), sample.z / (sample.sigma * residual.z));
}

}  // namespace palpate::depth
