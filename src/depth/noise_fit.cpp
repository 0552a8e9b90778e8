// Fits sigma(z) to samples of noise, and quadratic surfaces to windows of values.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "depth/noise_tracker.hpp"

namespace palpate::depth {
namespace {

// Farthest over nearest; below, the prior's shape is kept (judgement)
constexpr double kNarrow = 1.25;
constexpr int kCurveRounds = 5;  // of reweighting (judgement)
constexpr int kDescents = 200;   // passes over the terms (judgement)
// Relative error where a sample's weight halves (docs/method.md 6.2)
constexpr double kOutlier = 0.15;

using Curve = std::array<double, 3>;  // s0, s1, s2

double value(const Curve& c, double z) {
  return c[0] + z * (c[1] + z * c[2]);
}

NoiseModel scaled(std::span<const NoiseSample> samples, const NoiseModel& prior) {
  double sum = 0;
  double weights = 0;
  for (const NoiseSample& s : samples) {
    sum += s.weight * std::log(s.sigma / prior.sigma(s.z));
    weights += s.weight;
  }
  NoiseModel model = prior;
  for (double& c : model.coefficients) c *= std::exp(sum / weights);
  return model;
}

// Least squares of relative errors over sums of terms none of which is negative, so that no sum
// is; one term after the other.
Curve descend(std::span<const NoiseSample> samples, std::span<const Curve> terms,
              const Curve& last) {
  std::array<double, 4> amounts{};
  Curve curve{};
  for (int i = 0; i < kDescents; ++i) {
    for (std::size_t k = 0; k < terms.size(); ++k) {
      double slope = 0;
      double bend = 0;
      for (const NoiseSample& s : samples) {
        const double off = last == Curve{} ? 0 : (value(last, s.z) / s.sigma - 1) / kOutlier;
        const double weight = s.weight / (1 + off * off);
        const double t = value(terms[k], s.z) / s.sigma;
        slope += weight * t * (1 - value(curve, s.z) / s.sigma);
        bend += weight * t * t;
      }
      const double change = std::max(-amounts[k], slope / bend);
      amounts[k] += change;
      for (std::size_t j = 0; j < 3; ++j) curve[j] += change * terms[k][j];
    }
  }
  return curve;
}

}  // namespace

NoiseModel fit_noise_curve(std::span<const NoiseSample> samples, const NoiseModel& prior) {
  if (samples.empty()) return prior;
  double near = std::numeric_limits<double>::infinity();
  double far = 0;
  for (const NoiseSample& s : samples) {
    near = std::min(near, s.z);
    far = std::max(far, s.z);
  }
  if (far < kNarrow * near) return scaled(samples, prior);
  // The last one: noise that grows from the nearest sample on.
  const std::array<Curve, 4> terms{
      Curve{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {near * near, -2 * near, 1}};
  NoiseModel model = prior;
  model.coefficients = {};
  for (int round = 0; round < kCurveRounds; ++round) {
    model.coefficients = descend(samples, terms, model.coefficients);
  }
  return model;
}

namespace {

constexpr int kFitRounds = 4;  // each leaves an eighth of a hole's pull on the fit (judgement)
constexpr double kOneSurface = 0.75;  // share of the values that must lie on it (judgement)
constexpr float kDeviations = 3;      // beyond, a value is left out (docs/method.md 6.2)
// Sigma over the median of absolute values, on Gaussian noise: 1 / Phi^-1(3/4) (derived)
constexpr float kPerMedian = 1.4826F;
constexpr std::size_t kMedianOf = 256;  // values that a median takes, about (judgement)

}  // namespace

NoiseFit::NoiseFit(int size)
    : size_(size), residuals_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {
  sorted_.reserve(residuals_.size());
  const auto n = static_cast<std::size_t>(size);
  for (std::size_t k = 0; k < kDegrees; ++k) {
    Row& p = polynomials_[k];
    for (std::size_t i = 0; i < n; ++i) {
      p[i] = k == 0 ? 1.0F : polynomials_[k - 1][i] * ((2 * static_cast<float>(i) + 1) / n - 1);
    }
    for (std::size_t j = 0; j < k; ++j) {
      float along = 0;
      for (std::size_t i = 0; i < n; ++i) along += p[i] * polynomials_[j][i];
      for (std::size_t i = 0; i < n; ++i) p[i] -= along * polynomials_[j][i];
    }
    float squares = 0;
    for (std::size_t i = 0; i < n; ++i) squares += p[i] * p[i];
    for (std::size_t i = 0; i < n; ++i) p[i] /= std::sqrt(squares);
  }
}

void NoiseFit::subtract(std::span<const float> values, const Coefficients& surface) {
  const auto n = static_cast<std::size_t>(size_);
  const auto& q = polynomials_;
  for (std::size_t j = 0; j < n; ++j) {
    std::array<float, 3> row{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; a + b < 3; ++b) row[a] += surface[a][b] * q[b][j];
    }
    const float* in = values.data() + j * n;
    float* out = residuals_.data() + j * n;
    for (std::size_t i = 0; i < n; ++i) {
      out[i] = in[i] - reference_ - row[0] * q[0][i] - row[1] * q[1][i] - row[2] * q[2][i];
    }
  }
}

// Takes the median of some of them, which is enough.
float NoiseFit::typical_residual() {
  sorted_.clear();
  const std::size_t step = 1 + residuals_.size() / kMedianOf;
  for (std::size_t i = 0; i < residuals_.size(); i += step) {
    if (!std::isnan(residuals_[i])) sorted_.push_back(std::abs(residuals_[i]));
  }
  if (sorted_.empty()) return 0;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return kPerMedian * *middle;
}

// Coefficients of what lies within the limit; the rest counts as being on the surface.
NoiseFit::Coefficients NoiseFit::project(float limit) {
  const auto n = static_cast<std::size_t>(size_);
  std::array<Row, kDegrees> columns{};
  Row squares{};
  std::array<int, kLargest> inside{};
  for (std::size_t j = 0; j < n; ++j) {
    const float* residuals = residuals_.data() + j * n;
    for (std::size_t i = 0; i < n; ++i) {
      const bool in = std::abs(residuals[i]) <= limit;
      const float r = in ? residuals[i] : 0.0F;
      inside[i] += in ? 1 : 0;
      squares[i] += r * r;
      for (std::size_t b = 0; b < kDegrees; ++b) columns[b][i] += polynomials_[b][j] * r;
    }
  }
  Coefficients result{};
  inside_ = 0;
  squares_ = 0;
  for (std::size_t i = 0; i < n; ++i) {
    inside_ += inside[i];
    squares_ += squares[i];
    for (std::size_t a = 0; a < kDegrees; ++a) {
      for (std::size_t b = 0; a + b < kDegrees; ++b) {
        result[a][b] += polynomials_[a][i] * columns[b][i];
      }
    }
  }
  return result;
}

WindowNoise NoiseFit::fit(std::span<const float> values) {
  const auto first = std::find_if(values.begin(), values.end(), [](float x) { return x == x; });
  if (first == values.end()) return {};
  reference_ = *first;
  const auto enough = static_cast<int>(kOneSurface * static_cast<double>(values.size()));
  Coefficients surface{};
  Coefficients change{};
  float limit = std::numeric_limits<float>::infinity();
  for (int round = 0; round <= kFitRounds; ++round) {
    subtract(values, surface);
    if (round > 0) limit = kDeviations * typical_residual();
    change = project(limit);
    if (inside_ < enough) return {};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; a + b < 3; ++b) surface[a][b] += change[a][b];
    }
  }
  double cubic = 0;
  double moved = 0;
  for (std::size_t a = 0; a < kDegrees; ++a) {
    for (std::size_t b = 0; a + b < kDegrees; ++b) {
      (a + b < 3 ? moved : cubic) += change[a][b] * change[a][b];
    }
  }
  const double variance = squares_ / (inside_ - kTerms);
  if (moved > variance) return {};  // it has not come to rest
  return {static_cast<float>(variance),
          static_cast<float>(cubic / kDegrees * static_cast<double>(values.size()) / inside_),
          reference_ + surface[0][0] * polynomials_[0][0] * polynomials_[0][0]};
}

}  // namespace palpate::depth
