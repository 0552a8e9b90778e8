#include "depth/noise_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate::depth {
namespace {

constexpr int kFewestCorrelated = 4;  // windows
// Up to which n_c windows of a level are believed: those that are too small for the noise's
// correlation find a part of it only.
constexpr std::array<double, 3> kBelievedShared{1.6, 14, 1e9};
constexpr double kCorrelationCost = 10;  // of a window, in fits of it
constexpr double kExplained = 0.05;      // share of windows that may stand for all

}  // namespace

NoiseSurvey::NoiseSurvey()
    : levels_{NoiseLevel(10, 10, 3), NoiseLevel(20, 20, 6), NoiseLevel(40, 20, 12)} {
  noise_.samples.reserve(kNoiseBins);
}

void NoiseSurvey::resize(int width, int height) {
  for (NoiseLevel& level : levels_) level.resize(width, height);
  ratios_.reserve(levels_.back().windows());
  noise_.samples.clear();
  noise_.shared = 1;
  level_ = next_ = 0;
  correlating_ = false;
}

// One window, or the step to the next level. False: all are measured.
bool NoiseSurvey::measure_one(const DepthView& frame, double& budget) {
  NoiseLevel& level = levels_[level_];
  if (next_ < level.windows()) {
    level.measure(frame, next_++, fitter_);
    budget -= level.size() * level.size();
    return true;
  }
  level.find_flat();
  next_ = 0;
  return ++level_ < levels_.size();
}

bool NoiseSurvey::correlate_one(const DepthView& frame, double& budget) {
  NoiseLevel& level = levels_[level_];
  if (next_ < level.chosen()) {
    level.correlate(frame, next_++, fitter_);
    budget -= kCorrelationCost * level.size() * level.size();
    return true;
  }
  next_ = 0;
  return ++level_ < levels_.size();
}

bool NoiseSurvey::advance(const DepthView& frame, int shares) {
  double budget = 0;
  for (const NoiseLevel& level : levels_) {
    const double pixels = level.size() * level.size();
    budget += pixels * (static_cast<double>(level.windows()) +
                        kCorrelationCost * static_cast<double>(level.chosen()));
  }
  budget = std::max(1.0, budget / shares);
  if (shares == 1) budget = std::numeric_limits<double>::infinity();
  while (budget > 0) {
    if (!correlating_) {
      correlating_ = !measure_one(frame, budget);
      if (correlating_) level_ = 0;
    } else if (!correlate_one(frame, budget)) {
      conclude();
      level_ = 0;
      correlating_ = false;
      return true;
    }
  }
  return false;
}

// The smallest windows that hold the correlation; failing that, the largest that were flat.
void NoiseSurvey::conclude() {
  noise_.samples.clear();
  noise_.shared = 1;
  noise_.whole = false;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const NoiseLevel& level = levels_[i];
    if (level.correlated() < kFewestCorrelated) continue;
    const NoiseCorrelation correlation = level.correlation();
    if (!(correlation.variance > 0)) continue;
    noise_.shared = correlation.shared;
    noise_.whole = correlation.whole && correlation.shared <= kBelievedShared[i];
    noise_.samples.assign(level.samples().begin(), level.samples().end());
    const double raised = std::sqrt(std::max(1.0, correlation.variance));
    for (NoiseSample& sample : noise_.samples) sample.sigma *= raised;
    if (noise_.whole) break;
  }
}

double NoiseSurvey::misfit(const NoiseModel& model) {
  ratios_.clear();
  for (const WindowResidual& r : levels_.back().residuals()) {
    if (!r.usable || r.step <= 0 || r.block_variance <= 0) continue;
    ratios_.push_back(static_cast<float>(2 * std::sqrt(r.block_variance) / model.sigma(r.z)));
  }
  if (ratios_.empty()) return 1;
  // Where most of the image is clutter, windows that cross edges say nothing of the sensor.
  const auto explained = std::partition(ratios_.begin(), ratios_.end(),
                                        [](float ratio) { return ratio < kMostMisfit; });
  const auto all = static_cast<double>(ratios_.size());
  const auto count = static_cast<double>(explained - ratios_.begin());
  if (count < kExplained * all) return kMostMisfit;
  const auto quarter = ratios_.begin() + static_cast<std::ptrdiff_t>(count / 4);
  std::nth_element(ratios_.begin(), quarter, explained);
  return *quarter;
}

}  // namespace palpate::depth
