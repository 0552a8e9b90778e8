// Learns a camera's noise model over many frames.
#include "depth/noise_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace palpate::depth {
namespace {

constexpr std::size_t kShares = 128;  // frames in which all windows are visited once (judgement)
constexpr std::size_t kPatience = 8;  // frames from one conclusion to the next (judgement)
constexpr double kNoteworthy = 0.1;   // relative change that makes a new model (judgement)
constexpr double kPattern = 4;  // times the frames' differences; more is shape (docs/method.md 6.2)
constexpr double kMoved = 1.25;  // times the noise; larger differences are motion (judgement)
// Least c: windows grow in steps, and where pixels err alone some stop early by chance (judgement).
constexpr double kLeastCorrelation = 1.15;
constexpr float kSmallStep = 1e-6F;  // of the depth; smaller steps are rounding of floats (derived)
constexpr float kRounded = 0.02F;    // of a step: the least residual of rounding to it (judgement)
constexpr float kFinest = 1e-4F;     // of the depth: no depth camera errs less (judgement)

bool differs(double a, double b) {
  return std::abs(a - b) > kNoteworthy * b;
}

// Appends the depths of a window, NaN where there is none.
void append(const DepthView& frame, const NoiseWindow& window, std::vector<float>& depths) {
  const int size = kNoiseSizes[window.level];
  for (int v = window.v; v < window.v + size; ++v) {
    for (int u = window.u; u < window.u + size; ++u) {
      const float z = frame.at(u, v);
      depths.push_back(frame.valid(z) ? z : std::numeric_limits<float>::quiet_NaN());
    }
  }
}

// Differences between neighbours that are not 0.
struct Steps {
  float smallest = std::numeric_limits<float>::infinity();
  std::size_t count = 0;
};

Steps steps_of(const std::vector<float>& depths, std::size_t row) {
  Steps steps;
  for (std::size_t i = row; i < depths.size(); ++i) {
    bool differs = false;
    for (const float other : {depths[i - 1], depths[i - row]}) {
      const float step = std::abs(depths[i] - other);
      if (!(step > kSmallStep * depths[i])) continue;
      steps.smallest = std::min(steps.smallest, step);
      differs = true;
    }
    steps.count += differs ? 1 : 0;
  }
  return steps;
}

}  // namespace

// Measures noise in windows of frames of one size, a share of the windows in each turn.
struct WindowVisits {
  int width = 0;
  int height = 0;
  std::size_t turn = 0;  // windows i with i % kShares == turn are looked at
  std::vector<NoiseWindow> windows;
  std::vector<SeenNoise> single;       // what single frames show
  std::vector<SeenNoise> differences;  // what pairs differ by
  std::vector<float> before;           // the last frame's depths in this turn's windows
  std::array<NoiseFit, kNoiseSizes.size()> fits{NoiseFit(kNoiseSizes[0]), NoiseFit(kNoiseSizes[1]),
                                                NoiseFit(kNoiseSizes[2])};
  std::vector<float> values;

  void resize(const DepthView& frame);
  void look(const DepthView& frame, std::size_t window);
  void compare(const DepthView& frame);
  void keep(const DepthView& frame);
};

// Concludes a noise model from what the windows showed.
struct NoiseTracker::State {
  explicit State(const NoiseModel& given) : prior(given), model(given) {}

  NoiseModel prior;
  NoiseModel model;        // handed out
  std::size_t waited = 0;  // frames that gave no samples
  bool reported = false;
  WindowVisits visits;
  NoiseSurvey of_single;
  NoiseSurvey of_differences;
  std::vector<NoiseSample> samples;

  [[nodiscard]] std::span<const NoiseSample> changes() const;
  void choose_samples();
  [[nodiscard]] double shared(const NoiseModel& noise) const;
  void conclude();
  void update(const DepthView& frame);
};

void WindowVisits::resize(const DepthView& frame) {
  width = frame.width;
  height = frame.height;
  windows = lay_noise_windows(width, height);
  for (const NoiseWindow& window : windows) single.push_back({window.level, 0, {}});
  differences = single;
}

// Measures the noise of a window in inverse depths, in which planes are planes, too. Where most
// neighbours are alike and nothing is left, noise is below the sensor's step, or nothing was
// measured.
void WindowVisits::look(const DepthView& frame, std::size_t window) {
  values.clear();
  append(frame, windows[window], values);
  NoiseFit& fitter = fits[windows[window].level];
  const Steps steps = steps_of(values, static_cast<std::size_t>(fitter.size()));
  for (float& z : values) z = 1 / z;
  const WindowNoise noise = fitter.fit(values);
  SeenNoise& to = single[window];
  to.z = noise.mean > 0 ? 1 / noise.mean : 0;
  to.noise = {};
  const float square = to.z * to.z * to.z * to.z;
  const float seen = kRounded * steps.smallest;
  const bool stepped = noise.variance * square > seen * seen;
  if (to.z == 0 || (!stepped && 2 * steps.count < values.size())) return;
  float least = kFinest * to.z * kFinest * to.z;
  if (stepped) least = std::max(least, steps.smallest * steps.smallest / 12);
  const float more = std::max(0.0F, least - noise.variance * square);
  to.noise = {noise.variance * square + more, noise.power * square + more, noise.mean};
}

// In a static scene the difference of two frames is noise, whatever the shape.
void WindowVisits::compare(const DepthView& frame) {
  std::size_t at = 0;
  for (std::size_t w = turn; w < windows.size() && at < before.size(); w += kShares) {
    values.clear();
    append(frame, windows[w], values);
    double depth = 0;
    int count = 0;
    for (float& value : values) {
      const float z = value;
      value = (z - before[at++]) * std::numbers::sqrt2_v<float> / 2;
      if (std::isnan(value)) continue;
      depth += z;
      ++count;
    }
    const WindowNoise noise = fits[windows[w].level].fit(values);
    const auto z = static_cast<float>(depth / count);
    if (noise.variance > kFinest * z * kFinest * z) differences[w] = {windows[w].level, z, noise};
  }
}

// Keeps values to compare the next frame with.
void WindowVisits::keep(const DepthView& frame) {
  turn = (turn + 1) % kShares;
  before.clear();
  for (std::size_t w = turn; w < windows.size(); w += kShares) append(frame, windows[w], before);
}

// Samples from differences of frames; none while too few large windows are among them.
std::span<const NoiseSample> NoiseTracker::State::changes() const {
  const SurveyedNoise& noise = of_differences.noise();
  return std::span(noise.samples).first(noise.whole ? noise.samples.size() : 0);
}

// Takes the samples of single frames, which show a sensor's fixed pattern and its steps, too: fits
// stumble over these as over what changes. Limits them to kPattern times what changes, since more
// is shape that fills the image; where they are missing, differences of frames stand for them.
void NoiseTracker::State::choose_samples() {
  const std::span<const NoiseSample> pairs = changes();
  samples = of_single.noise().samples;
  const auto alone = [&](const NoiseSample& pair) {
    return std::none_of(samples.begin(), samples.end(), [&](const NoiseSample& sample) {
      return noise_bin(sample.z) == noise_bin(pair.z);
    });
  };
  const std::size_t singles = samples.size();
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(samples), alone);
  if (pairs.empty()) return;
  const NoiseModel changing = fit_noise_curve(pairs, prior);
  for (NoiseSample& sample : std::span(samples).first(singles)) {
    sample.sigma = std::min(sample.sigma, kPattern * changing.sigma(sample.z));
  }
}

// n_c of the whole noise, by that of the frames' differences, which hold no shape, but no pattern
// either: they count by their share of the noise.
double NoiseTracker::State::shared(const NoiseModel& noise) const {
  double shares = 0;  // of the noise, that they show
  double weights = 0;
  for (const NoiseSample& pair : changes()) {
    const double share = pair.sigma / noise.sigma(pair.z);
    if (share > kMoved) continue;
    shares += pair.weight * share * share;
    weights += pair.weight;
  }
  double from_single = of_single.noise().samples.empty() ? 0 : of_single.noise().shared;
  if (weights == 0) return std::max(1.0, from_single);
  const double from_pairs = shares / weights * of_differences.noise().shared;
  return std::max({1.0, from_pairs, std::min(from_single, kPattern * kPattern * from_pairs)});
}

void NoiseTracker::State::conclude() {
  of_single.conclude(visits.single);
  of_differences.conclude(visits.differences);
  choose_samples();
  if (samples.empty()) return;
  NoiseModel next = fit_noise_curve(samples, prior);
  next.correlation = std::max(kLeastCorrelation, std::sqrt(shared(next)));
  bool changed = !reported || differs(next.correlation, model.correlation);
  for (const NoiseSample& sample : samples) {
    changed = changed || differs(next.sigma(sample.z), model.sigma(sample.z));
  }
  if (changed) model = next;
  reported = true;
}

void NoiseTracker::State::update(const DepthView& frame) {
  if (frame.width != visits.width || frame.height != visits.height) {
    *this = State(prior);
    visits.resize(frame);
  }
  visits.compare(frame);
  const bool all = !reported && waited++ % kPatience == 0;
  const std::size_t count = visits.windows.size();
  for (std::size_t w = all ? 0 : visits.turn; w < count; w += all ? 1 : kShares) {
    visits.look(frame, w);
  }
  visits.keep(frame);
  if (all || visits.turn % kPatience == 0) conclude();
}

NoiseTracker::NoiseTracker(const NoiseModel& prior) : state_(std::make_unique<State>(prior)) {}

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
  *this = NoiseTracker(state_->prior);
}

}  // namespace palpate::depth
