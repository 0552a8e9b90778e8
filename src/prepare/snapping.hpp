#pragma once

#include <cstdint>
#include <vector>

#include "prepare/sheets.hpp"

namespace palpate {

inline constexpr std::uint32_t kNoHost = ~std::uint32_t{0};

/// Whose planes points lie on, in sorted order.
struct Snapped {
  std::vector<std::uint8_t> sure;    ///< 1: its own fit is a sheet's; 0: a host's is, or none
  std::vector<std::uint32_t> hosts;  ///< the sure point whose fit each has: itself, or another, or
                                     ///< kNoHost
  std::vector<Twin> twins;           ///< those that lie on a second plane
};

/// A point is sure of its plane where its own fit is smooth. At edges and creases, where it is not,
/// a point takes over the fit of the sure one on whose plane it lies. One that lies on none has no
/// confidence left, unless hardly anything is sure around it.
[[nodiscard]] Snapped snap_to_planes(const SheetInput& input, OwnSheets& own);

/// The curvature that a sure point's fit tells, 1/m: a sphere's cap of radius a and curvature k is
/// off its plane by k a^2 / sqrt(48) RMS.
[[nodiscard]] float bow(const SheetInput& input, const OwnSheets& own, std::uint32_t i);

// How far normals may turn where both fits are bowed, against the arc; and how far off the chord,
// against the turn: an arc's is half.
inline constexpr float kTurnMargin = 1.5f;
inline constexpr float kChord = 0.6f;

}  // namespace palpate
