#pragma once

#include <optional>

#include "field/oriented.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {

/// A surface of the label's points with its edges sharp: where points lie beside an edge, the mean
/// of the heights above what both planes leave takes the place of `smooth`. With its exact
/// gradient.
[[nodiscard]] Value with_edges(const FieldPlace& place, const Value& smooth) noexcept;

/// By what acute creases are closed: a length that is taken off the height as seen from the proxy's
/// side, m, with its gradient. 0 on single surfaces, between sheets that meet at 115 degrees and
/// more, and wherever the surface is not concave.
///
/// Where two sheets face each other within a support, their normals and heights cancel: the mean of
/// both stays near 0, or is free, far behind either of them, and a proxy slips through. With the
/// mean normal Nb and the concavity h = (Nb . A - sum v n.q / V) / R, signed by the side,
///
///   closure = 0.2 R chi(1 - |Nb|^2 / 0.7) chi(100 h),  chi(u) = u^2 (3 - 2u), u within 0 and 1
///
/// |Nb|^2 is 1/2 between two equal sheets at 90 degrees and 0 between parallel ones; the gate opens
/// before that, as sheets are seldom equal. h is half the gap, over R, between sheets that face
/// each other, and below 0 in the plate between sheets that face away, which keeps its shape.
[[nodiscard]] Value crease_closure(const FieldPlace& place) noexcept;

/// Smooth maximum of two lengths over a width k, of R, that may vary: C1 (docs/method.md 1).
[[nodiscard]] Value smooth_max(const Value& a, const Value& b, const Value& radius,
                               double width) noexcept;

/// The height above the sheets at a place as they meet there: what is across bounds free space with
/// what is in front, and what is behind bounds the solid with both (Facing). Nothing where no label
/// has more than `least` of trusted weight. With its exact gradient.
[[nodiscard]] std::optional<Value> joined_height(const FieldOptions& options, FieldPlace place,
                                                 double least) noexcept;

}  // namespace palpate
