#pragma once

#include "any_cloud/draft.hpp"

namespace palpate::any_cloud {

/// Two sheets that meet at x = z = 0 and open towards x; free is what lies between.
void make_fold(Draft& draft, double degrees);

/// Spacings a second.
inline constexpr double kSlide = 80;
inline constexpr double kPush = 100;
inline constexpr double kReach = 400;  ///< through free air

/// Goes down on the plane z = 0 and over a square of `half` to either side, `depth` below it, in
/// a direction and around a place that chance decides.
void zig_zag(Draft& draft, double depth, double half);

/// In, to the deepest place, and out where it came from.
void push(Draft& draft, const Eigen::Vector3d& from, const Eigen::Vector3d& deepest);

}  // namespace palpate::any_cloud
