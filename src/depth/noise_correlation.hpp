#pragma once

#include <vector>

namespace palpate::depth {

/// How neighbouring residuals of one size of window go together.
struct NoiseCorrelation {
  double shared = 1;    ///< n_c: sum of the noise's autocorrelation, pixels per independent one
  double variance = 0;  ///< of the noise, in the units of what was added
  bool whole = false;   ///< the autocorrelation ends within the lags that were looked at
};

/// Sums the autocovariance of windows' residuals over windows of one size. The fit has taken the
/// lowest frequencies out of them: with P the projection on the fitted terms and S the sum of the
/// noise's autocovariance, a residual's autocovariance at lag d is short of the noise's by
/// S p(d), p(d) the mean of P(x, x + d), as long as the noise is correlated over less than the
/// window. That is put back.
class CorrelationSum {
 public:
  CorrelationSum(int size, int reach);

  void clear();
  /// `scale` multiplies the residuals.
  void add(const std::vector<float>& residuals, const std::vector<float>& mask, double scale);

  [[nodiscard]] bool empty() const { return windows_ == 0; }
  [[nodiscard]] int windows() const { return windows_; }
  [[nodiscard]] NoiseCorrelation correlation() const;

 private:
  struct Lag {
    int du = 0;
    int dv = 0;
    int ring = 0;        // length, rounded
    double missing = 0;  // p(d)
    double products = 0;
    double pairs = 0;
  };

  /// Over the lags of one length, rounded, d and -d.
  struct Ring {
    double sum = 0;      // of the residuals' autocovariance
    double missing = 0;  // of p(d)
    double count = 0;
  };

  [[nodiscard]] double projection(int du, int dv) const;
  [[nodiscard]] Ring sum_ring(int ring) const;

  int size_ = 0;
  int reach_ = 0;
  int windows_ = 0;
  std::vector<Lag> lags_;  // half of the plane, the zero lag first
};

}  // namespace palpate::depth
