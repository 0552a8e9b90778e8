#pragma once

#include <numbers>

namespace palpate {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< rad

}  // namespace palpate
