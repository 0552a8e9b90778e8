#include "depth/noise_correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace palpate::depth {
namespace {

constexpr double kEnd = 0.05;          // correlation below which a ring counts as none
constexpr double kMostMissing = 0.75;  // of S: above, what is left tells too little

// Orthonormal polynomials of degree 0, 1, 2 at the `size` places of a row.
double polynomial(int degree, int i, int size) {
  const double n = size;
  const double x = i - (n - 1) / 2;
  const double mu = (n * n - 1) / 12;
  if (degree == 0) return 1 / std::sqrt(n);
  if (degree == 1) return x / std::sqrt(n * mu);
  return (x * x - mu) / std::sqrt(n * (n * n - 1) * (n * n - 4) / 180);
}

double lagged(int degree, int lag, int size) {
  double sum = 0;
  for (int i = 0; i + lag < size; ++i) {
    sum += polynomial(degree, i, size) * polynomial(degree, i + lag, size);
  }
  return sum;
}

// In four sums, so that it can be vectorised without changing their order.
float dot(const float* x, const float* y, int length) {
  std::array<float, 4> sums{};
  int i = 0;
  for (; i + 4 <= length; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) {
      sums[k] += x[i + static_cast<int>(k)] * y[i + static_cast<int>(k)];
    }
  }
  float rest = 0;
  for (; i < length; ++i) rest += x[i] * y[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest;
}

}  // namespace

CorrelationSum::CorrelationSum(int size, int reach) : size_(size), reach_(reach) {
  for (int dv = 0; dv <= reach; ++dv) {
    for (int du = dv == 0 ? 0 : -reach; du <= reach; ++du) {
      const int ring = static_cast<int>(std::lround(std::hypot(du, dv)));
      if (ring <= reach) lags_.push_back({du, dv, ring, projection(du, dv), 0, 0});
    }
  }
}

double CorrelationSum::projection(int du, int dv) const {
  const int au = std::abs(du);
  double sum = 0;
  for (int a = 0; a <= 2; ++a) {
    for (int b = 0; a + b <= 2; ++b) sum += lagged(a, au, size_) * lagged(b, dv, size_);
  }
  return sum / (static_cast<double>(size_ - au) * (size_ - dv));
}

void CorrelationSum::clear() {
  windows_ = 0;
  for (Lag& lag : lags_) lag.products = lag.pairs = 0;
}

void CorrelationSum::add(const std::vector<float>& residuals, const std::vector<float>& mask,
                         double scale) {
  ++windows_;
  const double square = scale * scale;
  const auto pixels = std::ptrdiff_t{size_} * size_;
  const bool full = std::find(mask.begin(), mask.begin() + pixels, 0.0F) == mask.begin() + pixels;
  for (Lag& lag : lags_) {
    const int first = std::max(0, -lag.du);
    const int length = size_ - std::abs(lag.du);
    double products = 0;
    double pairs = full ? static_cast<double>(length) * (size_ - lag.dv) : 0;
    for (int v = 0; v + lag.dv < size_; ++v) {
      const std::ptrdiff_t a = std::ptrdiff_t{v} * size_ + first;
      const std::ptrdiff_t b = a + std::ptrdiff_t{lag.dv} * size_ + lag.du;
      products += dot(&residuals[static_cast<std::size_t>(a)],
                      &residuals[static_cast<std::size_t>(b)], length);
      if (full) continue;
      pairs += dot(&mask[static_cast<std::size_t>(a)], &mask[static_cast<std::size_t>(b)], length);
    }
    lag.products += square * products;
    lag.pairs += pairs;
  }
}

CorrelationSum::Ring CorrelationSum::sum_ring(int ring) const {
  Ring total;
  for (const Lag& lag : lags_) {
    if (lag.ring != ring || lag.pairs == 0) continue;
    const double both = ring == 0 ? 1 : 2;
    total.sum += both * lag.products / lag.pairs;
    total.missing += both * lag.missing;
    total.count += both;
  }
  return total;
}

NoiseCorrelation CorrelationSum::correlation() const {
  NoiseCorrelation result;
  if (empty() || lags_[0].pairs == 0) return result;
  double sum = 0;        // of the residuals' autocovariance over the rings so far
  double missing = 0;    // of p(d) over them
  double whole_sum = 0;  // S
  for (int ring = 0; ring <= reach_; ++ring) {
    const Ring next = sum_ring(ring);
    if (ring > 0) {
      const double mean = (next.sum + whole_sum * next.missing) / next.count;
      result.whole = mean < kEnd * result.variance;
      if (result.whole || missing + next.missing > kMostMissing) break;
    }
    sum += next.sum;
    missing += next.missing;
    whole_sum = std::max(0.0, sum / (1 - missing));
    result.variance = lags_[0].products / lags_[0].pairs + whole_sum * lags_[0].missing;
  }
  if (result.variance > 0) result.shared = whole_sum / result.variance;
  return result;
}

}  // namespace palpate::depth
