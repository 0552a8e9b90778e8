#pragma once

#include "field/field_place.hpp"

namespace palpate {

/// The balanced surface's function with its gradient, and with sharp edges where the surface is
/// convex as seen from the given side (nss_fast.md section 1):
///
///   f = MEAN + sigma chi (RIMLS - MEAN),  chi = u^2 (3 - 2u),
///   u = (a - 0.002) / 0.048 within 0 and 1, a = [sum v n.q / V - Nb . A] / R
///
/// sigma is the share of the points that may be sharpened, sum v s / sum v. RIMLS is MEAN with
/// points that count less the more their normal differs from the surface's: twice, v_i is
/// multiplied by exp(-|n_i - n|^2 / 0.5^2), where n is the mean normal before (Oztireli et al.
/// 2009, with mean normals for gradients).
///
/// Where u = 0, as on planes and in creases, it is MEAN and costs as much: in a crease RIMLS would
/// open gaps between the faces.
[[nodiscard]] Value sharp_balanced(const FieldPlace& place) noexcept;

}  // namespace palpate
