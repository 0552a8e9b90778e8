#include "depth/noise_windows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate::depth {
namespace {

constexpr double kMeasured = 0.7;    // share of the pixels that a window needs
constexpr double kSmallStep = 1e-6;  // of the depth: rounding of floats is no step

// Sums of u^a and of q u^a along a row.
struct RowSums {
  std::array<double, 5> u{};
  std::array<double, 3> q{};
};

double coordinate(int i, int size) {
  return (2.0 * i + 1) / size - 1;
}

RowSums sum_row(const float* q, const float* mask, int size) {
  RowSums sums;
  for (int i = 0; i < size; ++i) {
    const double u = coordinate(i, size);
    const double u2 = u * u;
    const double m = mask[i];
    const double value = q[i];
    sums.u[0] += m;
    sums.u[1] += m * u;
    sums.u[2] += m * u2;
    sums.u[3] += m * u2 * u;
    sums.u[4] += m * u2 * u2;
    sums.q[0] += value;
    sums.q[1] += value * u;
    sums.q[2] += value * u2;
  }
  return sums;
}

}  // namespace

NoiseWindowFitter::NoiseWindowFitter()
    : residuals_(std::size_t{kLargest} * kLargest), mask_(residuals_.size()) {}

// Leaves inverse depths, counted from the first one, in residuals_.
void NoiseWindowFitter::gather(const DepthView& frame, const NoiseWindow& window) {
  reference_ = 0;
  depth_sum_ = 0;
  count_ = 0;
  step_ = std::numeric_limits<float>::infinity();
  std::size_t at = 0;
  for (int v = window.v; v < window.v + window.size; ++v) {
    for (int u = window.u; u < window.u + window.size; ++u, ++at) {
      const float z = frame.at(u, v);
      const bool valid = frame.valid(z);
      mask_[at] = valid ? 1.0F : 0.0F;
      residuals_[at] = 0;
      if (!valid) continue;
      if (count_ == 0) reference_ = 1.0 / z;
      residuals_[at] = static_cast<float>(1.0 / z - reference_);
      depth_sum_ += z;
      ++count_;
      if (u > window.u) take_step(z, frame.at(u - 1, v));
      if (v > window.v) take_step(z, frame.at(u, v - 1));
    }
  }
}

void NoiseWindowFitter::take_step(float z, float before) {
  const float step = std::abs(z - before);
  if (step > kSmallStep * z) step_ = std::min(step_, step);
}

// Coefficients of the surface through what gather() has left.
NoiseWindowFitter::Terms NoiseWindowFitter::surface(int size) const {
  struct Power {
    std::size_t u, v;
  };
  constexpr std::array<Power, kTerms> kPowers{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Terms right = Terms::Zero();
  for (int j = 0; j < size; ++j) {
    const auto begin = static_cast<std::size_t>(j) * static_cast<std::size_t>(size);
    const RowSums sums = sum_row(&residuals_[begin], &mask_[begin], size);
    const double v = coordinate(j, size);
    const std::array<double, 5> powers{1, v, v * v, v * v * v, v * v * v * v};
    for (int a = 0; a < kTerms; ++a) {
      const Power& row = kPowers[static_cast<std::size_t>(a)];
      right(a) += sums.q[row.u] * powers[row.v];
      for (int b = 0; b <= a; ++b) {
        const Power& column = kPowers[static_cast<std::size_t>(b)];
        normal(a, b) += sums.u[row.u + column.u] * powers[row.v + column.v];
      }
    }
  }
  return normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
}

// Leaves residuals as depth.
void NoiseWindowFitter::subtract(const Terms& c, int size) {
  const double z = depth_sum_ / count_;
  std::size_t at = 0;
  for (int j = 0; j < size; ++j) {
    const double v = coordinate(j, size);
    const double constant = c(0) + v * (c(2) + v * c(5));
    const double linear = c(1) + v * c(4);
    for (int i = 0; i < size; ++i, ++at) {
      const double u = coordinate(i, size);
      const double model = constant + u * (linear + u * c(3));
      residuals_[at] = mask_[at] * static_cast<float>((residuals_[at] - model) * z * z);
    }
  }
}

float NoiseWindowFitter::block_variance(int size) const {
  double squares = 0;
  int blocks = 0;
  for (int j = 0; j + 1 < size; j += 2) {
    for (int i = 0; i + 1 < size; i += 2) {
      const auto a = static_cast<std::size_t>(j) * static_cast<std::size_t>(size) +
                     static_cast<std::size_t>(i);
      const std::size_t b = a + static_cast<std::size_t>(size);
      if (mask_[a] + mask_[a + 1] + mask_[b] + mask_[b + 1] < 4) continue;
      const double mean =
          0.25 * (residuals_[a] + residuals_[a + 1] + residuals_[b] + residuals_[b + 1]);
      squares += mean * mean;
      ++blocks;
    }
  }
  return blocks > 2 * kTerms ? static_cast<float>(squares / (blocks - kTerms)) : 0.0F;
}

WindowResidual NoiseWindowFitter::fit(const DepthView& frame, const NoiseWindow& window) {
  gather(frame, window);
  WindowResidual result;
  if (count_ < kMeasured * window.size * window.size) return result;
  const Terms c = surface(window.size);
  if (!c.allFinite()) return result;
  subtract(c, window.size);
  double squares = 0;
  const auto pixels = static_cast<std::size_t>(window.size) * static_cast<std::size_t>(window.size);
  for (std::size_t i = 0; i < pixels; ++i) squares += residuals_[i] * residuals_[i];
  result.usable = true;
  result.z = static_cast<float>(depth_sum_ / count_);
  result.variance = static_cast<float>(squares / (count_ - kTerms));
  result.block_variance = block_variance(window.size);
  result.step = std::isfinite(step_) ? step_ : 0;
  return result;
}

}  // namespace palpate::depth
