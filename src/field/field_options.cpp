// Checks field options and computes the level of a plane (docs/method.md 2.1).

#include "palpate/field/field_options.hpp"

#include "base/requirement.hpp"
#include "field/description.hpp"
#include "field/formulas.hpp"

namespace palpate {

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
  return -plane_norm(kernel) * eta * evaluate(kernel, eta * eta).w;
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

void check(const FieldOptions& options) {
  check_described("field", options);
  const Requirement require{"field"};
  require(options.raw_weights || options.threshold < 1, "threshold", options.threshold,
          "give less than 1 with density-normalised weights (usually 0.4)");
  require(options.tool_radius == 0 || !options.raw_weights, "tool_radius", options.tool_radius,
          "give 0 with raw weights (the preset `paper` uses a point tool)");
}

FieldOptions paper_field(FieldOptions::Kind kind) {
  FieldOptions options;
  options.kind = kind;
  options.gradient = kind == FieldOptions::Kind::pointset ? FieldOptions::Gradient::normal
                                                          : FieldOptions::Gradient::exact;
  options.threshold = 0.5;
  options.capped = false;
  options.sharp_edges = false;
  options.raw_weights = true;
  options.nearest_radius = true;
  return options;
}

}  // namespace palpate
