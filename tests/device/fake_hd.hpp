#pragma once

#include <array>

namespace palpate::test {

/// What a test wants of the first device of fake_hd.cpp: faults, and what it tells of itself.
struct FakeHd {
  bool plugged = true;
  bool busy = false;
  bool not_a_number = false;
  bool hangs = false;    ///< in the next frame, until this is taken back
  unsigned failing = 0;  ///< the error's code
  unsigned calibration = 0x5000;
  int styles = 4;            ///< of calibration
  double temperature = 0.1;  ///< of the warmest motor
  std::array<char, 32> model = {"Touch"};
  double continuous_force = 0.88;  ///< N
  double continuous_torque = 0;    ///< mN m
  double stiffness = 0.4;          ///< N/mm
  double turned = 0;               ///< of the stylus about the maker's y, rad
  double pause = 1e-3;             ///< s from a tick to the next
  double opening = 2e-3;           ///< s that it takes to open or to close either device
  unsigned failing_meanwhile = 0;  ///< an error of the second one while the first is opened
};

}  // namespace palpate::test
