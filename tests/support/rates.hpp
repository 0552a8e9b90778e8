#pragma once

namespace palpate::test {

inline constexpr double kTick = 1e-3;      ///< of the servo, s
inline constexpr double kFrame = 1. / 30;  ///< of a depth camera, s

}  // namespace palpate::test
