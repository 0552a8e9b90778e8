#pragma once

#include <optional>

#include "field/field_place.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {

/// Smooth maximum of two lengths over a width k, of R, that may vary: C1 (algorithm.md 1.4).
[[nodiscard]] Value smooth_max(const Value& a, const Value& b, const Value& radius,
                               double width) noexcept;

/// The height above the sheets at a place as they meet there: what is across bounds free space with
/// what is in front, and what is behind bounds the solid with both (Facing). Nothing where no label
/// has more than `least` of trusted weight. With its exact gradient.
[[nodiscard]] std::optional<Value> joined_height(const FieldOptions& options, FieldPlace place,
                                                 double least) noexcept;

}  // namespace palpate
