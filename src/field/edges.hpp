#pragma once

#include "field/field_place.hpp"

namespace palpate {

/// A surface of the label's points with its edges sharp: where points lie beside an edge, the mean
/// of the heights above what both planes leave takes the place of `smooth`. With its exact
/// gradient.
[[nodiscard]] Value with_edges(const FieldPlace& place, const Value& smooth) noexcept;

}  // namespace palpate
