#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <functional>

namespace palpate::io {

/// Coordinates beyond this many metres are no place on any survey, and their squares would leave
/// the range of float; a point that has one is dropped like one that is not finite.
inline constexpr double kLargestCoordinate = 1e12;

[[nodiscard]] inline bool is_usable(const Eigen::Vector3d& point) {
  return (point.array().abs() <= kLargestCoordinate).all();  // false for NaN as well
}

/// The origin for a cloud: zero where floats around zero lose at most four bits, otherwise a round
/// point (1, 10, 100 ... metres, as the cloud's size is) near the median. Medians, of a sample of
/// about a thousand points, because one stray point at zero must not cost a survey its digits.
/// @param point_at the i-th of `count` points in metres; points that are not usable are left out.
[[nodiscard]] Eigen::Vector3d choose_origin(
    std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& point_at);

}  // namespace palpate::io
