#include "depth/noise_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate::depth {
namespace {

constexpr double kNarrow = 1.25;   // farthest over nearest: below, the prior's shape is kept
constexpr int kCurveRounds = 5;    // of reweighting
constexpr int kDescents = 200;     // of the terms, one after the other
constexpr double kOutlier = 0.15;  // relative error from which on a sample counts less

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

}  // namespace palpate::depth
