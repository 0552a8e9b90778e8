#pragma once

#include "palpate/io/trajectory.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::servo_cost {

/// A hand that explores what the first source of `scene` shows for `seconds`, always in the same
/// way.
[[nodiscard]] Trajectory hand_over(const Scene& scene, double seconds);

}  // namespace palpate::servo_cost
