#include "palpate/field/field_options.hpp"

#include "base/requirement.hpp"

namespace palpate {
void check(const FieldOptions& options) {
  const Requirement require{"field"};
  require.positive("threshold", options.threshold, "give a number above 0");
  require(options.raw_weights || options.threshold < 1, "threshold", options.threshold,
          "give less than 1 with density-normalised weights (0.4 unless there is a reason)");
  require(options.minimum_support > 0 && options.minimum_support < 1, "minimum_support",
          options.minimum_support, "give a number between 0 and 1");
  require.not_negative("tool_radius", options.tool_radius, "give 0 or more, in metres");
  require(options.tool_radius == 0 || !options.raw_weights, "tool_radius", options.tool_radius,
          "give 0 with raw weights (the preset `paper` has a point for a tool)");
}

FieldOptions paper_field(FieldKind kind) {
  FieldOptions options;
  options.kind = kind;
  options.gradient = kind == FieldKind::pointset ? GradientKind::normal : GradientKind::exact;
  options.threshold = 0.5;
  options.capped = false;
  options.sharp_edges = false;
  options.raw_weights = true;
  options.nearest_radius = true;
  return options;
}

}  // namespace palpate
