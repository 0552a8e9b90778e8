#include "palpate/field/kernel.hpp"

namespace palpate {
namespace {

// 1 / integral of w(r) r dr over [0, 1].
constexpr double kWyvillNorm = 27. / 4;
constexpr double kWendlandNorm = 14;

}  // namespace

double plane_threshold(Kernel kernel, double eta) noexcept {
  if (eta >= 1) return 0;
  if (kernel == Kernel::wyvill) {
    const double q = eta * eta;
    return 1 - 27. / 8 * q * (1 + q * (-11. / 9 + q * (17. / 27 - q / 9)));
  }
  const double s = 1 - eta;
  return s * s * s * s * s * (14 + s * (-21 + s * 8));
}

double plane_threshold_slope(Kernel kernel, double eta) noexcept {
  const double norm = kernel == Kernel::wyvill ? kWyvillNorm : kWendlandNorm;
  return -norm * eta * evaluate(kernel, eta * eta).w;
}

double plane_offset(Kernel kernel, double threshold) noexcept {
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (plane_threshold(kernel, middle) > threshold ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace palpate
