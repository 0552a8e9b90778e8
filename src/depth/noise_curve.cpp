#include "depth/noise_curve.hpp"

#include <Eigen/Dense>
#include <array>
#include <limits>
#include <optional>

namespace palpate::depth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNarrow = 1.25;   // farthest over nearest: below, the prior's shape is kept
constexpr double kWide = 1.6;      // from here on all three terms are free
constexpr int kRounds = 5;         // of reweighting
constexpr double kOutlier = 0.15;  // relative error from which on a sample counts less

double value(const Vector3d& c, double z) {
  return c(0) + z * (c(1) + z * c(2));
}

double relative_error(const Vector3d& c, const NoiseSample& s) {
  return value(c, s.z) / s.sigma - 1;
}

double robust_weight(const Vector3d& c, const NoiseSample& s) {
  const double e = relative_error(c, s) / kOutlier;
  return s.weight / (1 + e * e);
}

// Sum of the robust losses: what the reweighting brings down.
double loss(const Vector3d& c, std::span<const NoiseSample> samples) {
  double sum = 0;
  for (const NoiseSample& s : samples) {
    const double e = relative_error(c, s) / kOutlier;
    sum += s.weight * std::log1p(e * e);
  }
  return sum;
}

/// Least squares over the terms that `used` names; the others are 0.
Vector3d fit_terms(std::span<const NoiseSample> samples, const std::array<bool, 3>& used) {
  Vector3d c = Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Matrix3d normal = Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const NoiseSample& s : samples) {
      const double w = round == 0 ? s.weight : robust_weight(c, s);
      const Vector3d row = Vector3d(1, s.z, s.z * s.z) / s.sigma;
      normal += w * row * row.transpose();
      right += w * row;
    }
    for (int i = 0; i < 3; ++i) {
      if (used[static_cast<std::size_t>(i)]) continue;
      normal.row(i).setZero();
      normal.col(i).setZero();
      normal(i, i) = 1;
      right(i) = 0;
    }
    c = normal.ldlt().solve(right);
  }
  return c;
}

/// Nearest and farthest depth that samples lie at.
struct Span {
  double near = std::numeric_limits<double>::infinity();
  double far = 0;
};

Span span_of(std::span<const NoiseSample> samples) {
  Span span;
  for (const NoiseSample& s : samples) {
    span.near = std::min(span.near, s.z);
    span.far = std::max(span.far, s.z);
  }
  return span;
}

/// Can the curve be believed beyond the samples?
bool sane(const Vector3d& c, const Span& span) {
  if (!c.allFinite() || c(2) < 0) return false;
  const double near = value(c, span.near);
  const double far = value(c, span.far);
  const double before = value(c, span.near / 2);
  const bool rises = c(1) + 2 * c(2) * span.far >= 0;
  const double lowest_at = c(2) > 0 ? std::max(0.0, -c(1) / (2 * c(2))) : 0;
  return near > 0 && far > 0 && rises && before > 0.4 * near && before < 1.2 * near &&
         value(c, lowest_at) > 0.4 * near && value(c, 0) < 1.6 * near;
}

// The best curve of one or two terms that are not negative: such curves are sane by themselves.
Vector3d fit_positive(std::span<const NoiseSample> samples) {
  Vector3d best = Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (unsigned mask = 1; mask < 7; ++mask) {
    const std::array<bool, 3> used{(mask & 1U) != 0, (mask & 2U) != 0, (mask & 4U) != 0};
    const Vector3d c = fit_terms(samples, used);
    if (!c.allFinite() || c.minCoeff() < 0) continue;
    const double l = loss(c, samples);
    if (l >= least) continue;
    least = l;
    best = c;
  }
  return best;
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

}  // namespace

NoiseModel fit_noise_curve(std::span<const NoiseSample> samples, const NoiseModel& prior) {
  if (samples.empty()) return prior;
  const Span span = span_of(samples);
  if (samples.size() < 2 || span.far < kNarrow * span.near) return scaled(samples, prior);
  Vector3d c = Vector3d::Zero();
  const bool all_terms = samples.size() >= 4 && span.far > kWide * span.near;
  if (all_terms) c = fit_terms(samples, {true, true, true});
  if (!all_terms || !sane(c, span)) c = fit_positive(samples);
  if (!(c.maxCoeff() > 0)) return scaled(samples, prior);
  NoiseModel model = prior;
  model.coefficients = {c(0), c(1), c(2)};
  return model;
}

}  // namespace palpate::depth
