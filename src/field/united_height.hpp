#pragma once

#include "field/oriented.hpp"

namespace palpate {

/// By what the height over all points moves where sources tell of one surface at different heights,
/// m, with its gradient; 0 for a single source, and nothing where they agree.
///
/// Summed up together, points count by how near they are. Where two sources' surfaces lie more than
/// 0.7 R apart, the height is that of the one here and of the other there: two sheets with a gap,
/// between which a proxy falls. Here each source has a height f_s = -sum v n.q / V_s of its own,
/// which counts by how much of the source's surface there is, whatever its height, and how finely
/// the source sees it:
///
///   c_s = V_s / (Phi(f_s / R) R_s^4),  lambda_s = c_s / sum c,
///   shift = tau (sum lambda_s f_s - sum V_s f_s / V)
///
/// Phi is what the weights of a plane at that height sum to. R_s, the source's mean radius, grows
/// as its rays graze, so that a source has faded before its surface ends at a silhouette. tau,
/// taken from |sum lambda_s n_s|, is 1 where normals of two sources differ by less than 11 degrees
/// and 0 from 23 on: the faces of an edge or of a thin plate do not disagree.
[[nodiscard]] Value united_shift(const FieldPlace& place) noexcept;

}  // namespace palpate
