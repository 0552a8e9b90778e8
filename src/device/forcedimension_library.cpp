#include "device/forcedimension_library.hpp"

namespace palpate::device {

ForceDimensionLibrary::ForceDimensionLibrary(const std::string& file)
    : library({file},
              "Force Dimension's SDK 3 brings it (forcedimension.com, for Linux): copy it to "
              "/usr/local/lib and run ldconfig") {
  library.find("dhdGetDeviceCount", count);
  library.find("dhdOpenID", open);
  library.find("dhdClose", close);
  library.find("dhdGetSystemName", title);
  library.find("dhdGetStatus", status);
  library.find("dhdEnableForce", enable_force);
  library.find("dhdEnableExpertMode", enable_expert_mode);
  library.find("dhdDisableExpertMode", disable_expert_mode);
  library.find("dhdSetWatchdog", set_watchdog);
  library.find("dhdGetPosition", position);
  library.find("dhdGetLinearVelocity", velocity);
  library.find("dhdGetButtonMask", buttons);
  library.find("dhdHasWrist", has_wrist);
  library.find("dhdHasGripper", has_gripper);
  library.find("dhdGetOrientationFrame", orientation);
  library.find("dhdGetGripperGap", gripper);
  library.find("dhdSetForceAndTorqueAndGripperForce", set_force);
  library.find("dhdErrorGetLastStr", last_error_);
}

std::string ForceDimensionLibrary::last_words() const {
  const char* words = last_error_();
  return words == nullptr || *words == '\0' ? "no reason given" : words;
}

}  // namespace palpate::device
