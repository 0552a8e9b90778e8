// Finds the noise that windows all over the image have in common, by depth.
#include <algorithm>
#include <cmath>

#include "depth/noise_tracker.hpp"

namespace palpate::depth {
namespace {

constexpr double kWindows = 256;    // of one size in an image, about (judgement)
constexpr std::size_t kFewest = 4;  // windows that make a sample (judgement)
// Log of variances: half of them lie within a factor of 4 (judgement)
constexpr float kAlike = 1.4F;
constexpr float kFlat = 2;  // variances up to this times the sample's are noise (judgement)
// Median of the mean of four squares of unit Gaussians (derived: of chi^2 with 4 degrees, over 4)
constexpr double kMedianOfFour = 0.839;
constexpr double kMissing = 0.125;  // share of the noise that a size may take for shape (judgement)

// Where n_c grew by a factor f from windows of half the size, infinite ones are taken to find
// f^kSharedPower times more (judgement). For Gaussian correlation over up to a tenth of the size,
// n_c comes out 6 % too small at most.
constexpr double kSharedPower = 0.6;

// Mean and width of the half of sorted values that lie closest together.
struct Half {
  float middle = 0;
  float width = 0;
};

Half closest_half(std::vector<float>& values) {
  std::sort(values.begin(), values.end());
  const std::size_t count = (values.size() + 1) / 2;
  std::size_t best = 0;
  for (std::size_t i = 0; i + count <= values.size(); ++i) {
    if (values[i + count - 1] - values[i] < values[best + count - 1] - values[best]) best = i;
  }
  float sum = 0;
  for (std::size_t i = best; i < best + count; ++i) sum += values[i];
  return {sum / static_cast<float>(count), values[best + count - 1] - values[best]};
}

}  // namespace

std::vector<NoiseWindow> lay_noise_windows(int width, int height) {
  std::vector<NoiseWindow> windows;
  const auto apart = static_cast<int>(std::sqrt(width * height / kWindows));
  for (std::size_t level = 0; level < kNoiseSizes.size(); ++level) {
    const int size = kNoiseSizes[level];
    const int stride = std::max(size / 2, apart);
    for (int v = 0; v + size <= height; v += stride) {
      for (int u = 0; u + size <= width; u += stride) windows.push_back({level, u, v});
    }
  }
  return windows;
}

// Each orthonormal term takes the noise's power at its own wavelength.
double NoiseSurvey::Level::missing(int size) const {
  return NoiseFit::kTerms * power / (size * size);
}

void NoiseSurvey::find_samples(std::span<const SeenNoise> windows, std::size_t level) {
  auto& bins = levels_[level].bins;
  bins = {};
  int silent = 0;
  for (const SeenNoise& w : windows) {
    if (w.level == level && w.z > 0) silent += w.noise.variance > 0 ? -1 : 1;
  }
  if (silent > 0) return;  // then what the others show are jumps
  for (int bin = 0; bin < kNoiseBins; ++bin) {
    values_.clear();
    double depths = 0;
    for (const SeenNoise& w : windows) {
      if (w.level != level || !(w.noise.variance > 0) || noise_bin(w.z) != bin) continue;
      values_.push_back(std::log(w.noise.variance) - 4 * std::log(w.z));
      depths += w.z;
    }
    if (values_.size() < kFewest) continue;
    const Half half = closest_half(values_);
    if (half.width > kAlike) continue;
    const auto count = static_cast<double>(values_.size());
    const double z = depths / count;
    bins[static_cast<std::size_t>(bin)] = {z, z * z * std::exp(half.middle / 2.0), count};
  }
}

void NoiseSurvey::find_power(std::span<const SeenNoise> windows, std::size_t level) {
  values_.clear();
  for (const SeenNoise& w : windows) {
    if (w.level != level || !(w.noise.variance > 0)) continue;
    const NoiseSample& sample = levels_[level].bins[static_cast<std::size_t>(noise_bin(w.z))];
    if (sample.weight == 0) continue;
    const double sigma = sample.sigma * w.z * w.z / (sample.z * sample.z);
    if (w.noise.variance > kFlat * sigma * sigma) continue;
    values_.push_back(w.noise.power / w.noise.variance);
  }
  levels_[level].power = 0;
  if (values_.size() < kFewest) return;
  const auto middle = values_.begin() + static_cast<std::ptrdiff_t>(values_.size() / 2);
  std::nth_element(values_.begin(), middle, values_.end());
  levels_[level].power = *middle / kMedianOfFour;
}

// Ratio of the variances in windows of two sizes, where both were measured; 0: nowhere.
double NoiseSurvey::growth(std::size_t from, std::size_t to) const {
  double sum = 0;
  double weights = 0;
  for (std::size_t bin = 0; bin < kNoiseBins; ++bin) {
    const NoiseSample& a = levels_[from].bins[bin];
    const NoiseSample& b = levels_[to].bins[bin];
    if (a.weight == 0 || b.weight == 0) continue;
    const double weight = std::min(a.weight, b.weight);
    sum += weight * 2 * std::log(b.sigma / a.sigma);
    weights += weight;
  }
  return weights > 0 ? std::exp(sum / weights) : 0;
}

// Do windows of this size see the noise as a whole?
bool NoiseSurvey::holds(std::size_t level) const {
  const double missing = levels_[level].missing(kNoiseSizes[level]);
  if (missing > kMissing) return false;
  if (level + 1 == kNoiseSizes.size()) return true;
  const double larger = levels_[level + 1].missing(kNoiseSizes[level + 1]);
  const double more = growth(level, level + 1) * (1 + larger) / (1 + missing);
  return more < 1 + 2 * kMissing || more > std::exp(kAlike);  // or it is all shape
}

// The smallest windows that hold the correlation; failing that, the largest that were flat.
void NoiseSurvey::conclude(std::span<const SeenNoise> windows) {
  noise_.samples.clear();
  noise_.shared = 1;
  noise_.whole = false;
  for (std::size_t level = 0; level < kNoiseSizes.size(); ++level) {
    find_samples(windows, level);
    find_power(windows, level);
  }
  std::size_t chosen = 0;
  for (std::size_t level = 0; level < kNoiseSizes.size(); ++level) {
    if (levels_[level].power == 0) continue;
    chosen = level;
    if (holds(level)) break;
  }
  const Level& level = levels_[chosen];
  if (level.power == 0) return;
  noise_.whole = chosen + 1 == levels_.size() || holds(chosen);
  double more = 1;
  if (chosen > 0 && levels_[chosen - 1].power > 0) {
    more = growth(chosen - 1, chosen) * level.power / levels_[chosen - 1].power;
  }
  const double power = level.power * std::pow(std::max(1.0, more), kSharedPower);
  const int size = kNoiseSizes[chosen];
  const double raised = 1 + NoiseFit::kTerms * (level.power + power) / (2 * size * size);
  noise_.shared = power / raised;
  for (NoiseSample sample : level.bins) {
    if (sample.weight == 0) continue;
    sample.sigma *= std::sqrt(raised);
    noise_.samples.push_back(sample);
  }
}

}  // namespace palpate::depth
