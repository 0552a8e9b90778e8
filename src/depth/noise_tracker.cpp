#include "depth/noise_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "depth/noise_curve.hpp"
#include "depth/noise_pairs.hpp"
#include "depth/noise_survey.hpp"

namespace palpate::depth {
namespace {

constexpr int kShares = 128;         // frames that one round of the survey takes
constexpr int kPatience = 8;         // as long as no frame tells anything, every 8th is looked at
constexpr double kMargin = 1.05;     // on c from windows that hold the correlation
constexpr double kWideMargin = 1.2;  // on c from what is known to come out low
constexpr double kNoteworthy = 0.1;  // relative change that is handed out
constexpr double kNewest = 0.3;      // weight of a round in the running means of c and misfit
constexpr double kLeast = 0.5;       // of what a single frame shows, what frames may differ by
constexpr double kMost = 1.3;
constexpr double kPattern = 4;  // times that, a fixed pattern: what is larger is what is seen

/// c by the rule of nss_fast.md section 2: what the noise's correlation asks for, and what wide
/// windows miss, whatever the cause.
double correlation(const FrameNoise& frame, double pair_shared, double misfit) {
  const double margin = frame.whole ? kMargin : kWideMargin;
  const double from_frame = margin * std::sqrt(frame.shared) / 2;
  const double from_pairs = kMargin * std::sqrt(pair_shared) / 2;
  return std::max({1.0, from_frame, from_pairs, kWideMargin * misfit});
}

bool differs(const NoiseModel& a, const NoiseModel& b, double z) {
  return std::abs(a.sigma(z) - b.sigma(z)) > kNoteworthy * b.sigma(z);
}

}  // namespace

struct NoiseTracker::State {
  NoiseModel prior;
  NoiseModel model;  // handed out
  NoiseModel spatial;
  int width = 0;
  int height = 0;
  int waited = 0;          // frames that have told nothing
  bool surveyed = false;   // single frames have told something
  double correlation = 1;  // running mean
  NoiseSurvey survey;
  NoisePairs pairs;
  std::vector<NoiseSample> samples;

  void update(const DepthView& frame);
  void resize(const DepthView& frame);
  [[nodiscard]] NoiseModel curve();
  void conclude(bool round);
};

void NoiseTracker::State::resize(const DepthView& frame) {
  if (frame.width == width && frame.height == height) return;
  width = frame.width;
  height = frame.height;
  survey.resize(width, height);
  pairs.resize(width, height);
  samples.reserve(2 * kNoiseBins);
  waited = 0;
  surveyed = false;
  model = spatial = prior;
}

// Frames' differences decide where there are any; elsewhere single frames do, in proportion.
NoiseModel NoiseTracker::State::curve() {
  samples.clear();
  double excess = 0;
  double weights = 0;
  for (NoiseSample sample : pairs.noise().samples) {
    const double single = spatial.sigma(sample.z);
    const double least = std::min(kLeast * single, kPattern * sample.sigma);
    sample.sigma = std::clamp(sample.sigma, least, kMost * single);
    samples.push_back(sample);
    excess += sample.weight * std::log(sample.sigma / single);
    weights += sample.weight;
  }
  if (weights == 0) return spatial;
  const double factor = std::exp(excess / weights);
  const std::size_t compared = samples.size();
  for (NoiseSample sample : survey.noise().samples) {
    const auto same_bin = [&](const NoiseSample& s) {
      return noise_bin(s.z) == noise_bin(sample.z);
    };
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>(compared);
    if (std::any_of(samples.begin(), end, same_bin)) continue;
    sample.sigma *= factor;
    samples.push_back(sample);
  }
  return fit_noise_curve(samples, prior);
}

void NoiseTracker::State::conclude(bool round) {
  NoiseModel next = curve();
  if (round || !surveyed) {
    const double newest =
        depth::correlation(survey.noise(), pairs.noise().shared, survey.misfit(next));
    correlation += (surveyed ? kNewest : 1.0) * (newest - correlation);
  }
  next.correlation = correlation;
  bool changed =
      !surveyed || std::abs(next.correlation - model.correlation) > kNoteworthy * model.correlation;
  for (const NoiseSample& sample : survey.noise().samples) {
    changed = changed || differs(next, model, sample.z);
  }
  if (changed) model = next;
  surveyed = true;
}

void NoiseTracker::State::update(const DepthView& frame) {
  resize(frame);
  if (!pairs.add(frame, spatial, survey.noise().shared)) return;
  if (!surveyed && waited++ % kPatience > 0) return;
  const bool round = survey.advance(frame, surveyed ? kShares : 1);
  if (survey.noise().samples.empty()) return;
  if (round) spatial = fit_noise_curve(survey.noise().samples, prior);
  conclude(round);
}

NoiseTracker::NoiseTracker(const NoiseModel& prior) : state_(std::make_unique<State>()) {
  state_->prior = state_->model = state_->spatial = prior;
}

NoiseTracker::~NoiseTracker() = default;
NoiseTracker::NoiseTracker(NoiseTracker&&) noexcept = default;
NoiseTracker& NoiseTracker::operator=(NoiseTracker&&) noexcept = default;

const NoiseModel& NoiseTracker::update(const DepthView& frame) {
  state_->update(frame);
  return state_->model;
}

const NoiseModel& NoiseTracker::model() const {
  return state_->model;
}

void NoiseTracker::reset() {
  const NoiseModel prior = state_->prior;
  state_ = std::make_unique<State>();
  state_->prior = state_->model = state_->spatial = prior;
}

}  // namespace palpate::depth
