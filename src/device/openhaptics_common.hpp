#pragma once

#include <map>
#include <mutex>
#include <string>

#include "device/frame_gate.hpp"
#include "device/openhaptics_errors.hpp"

namespace palpate::device {

/// What a program's devices have in common, since OpenHaptics is one library, with one current
/// device, one scheduler, and one list of errors.
struct OpenHapticsCommon {
  std::mutex mutex;  ///< of whoever opens or closes a device; frames never take it
  int users = 0;     ///< of the scheduler; under the mutex
  std::map<std::string, double> opened;  ///< when each was tried last, s; under the mutex
  FrameGate gate;                        ///< closed under the mutex
  OpenHapticsErrors errors;
};

/// This program's.
OpenHapticsCommon& openhaptics_common();

}  // namespace palpate::device
