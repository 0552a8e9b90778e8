#include "palpate/field/field_options.hpp"

namespace palpate {

FieldOptions paper_field(FieldKind kind) {
  FieldOptions options;
  options.kind = kind;
  options.gradient = kind == FieldKind::pointset ? GradientKind::normal : GradientKind::exact;
  options.threshold = 0.5;
  options.two_sided = false;
  options.capped = false;
  options.sharp_edges = false;
  options.raw_weights = true;
  options.nearest_radius = true;
  return options;
}

}  // namespace palpate
