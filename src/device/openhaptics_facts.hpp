#pragma once

#include <array>

namespace palpate::device {

/// What OpenHaptics tells of a device that is open. 0, or empty: it does not tell.
struct OpenHapticsFacts {
  std::array<char, 64> model{};
  std::array<char, 64> serial_number{};
  double continuous_force = 0;   ///< N
  double maximum_stiffness = 0;  ///< N/m
  double temperature = 0;        ///< of the warmest motor, from 0 to 1: as warm as may be
  int calibration_styles = 0;    ///< hd::kEncoderReset, hd::kAutomatic, hd::kInkwell
};

}  // namespace palpate::device
