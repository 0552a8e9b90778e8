#include "device/openhaptics_library.hpp"

#include <fmt/format.h>

#include "device/openhaptics_codes.hpp"

namespace palpate::device {
namespace {

constexpr const char* kBroughtBy =
    "OpenHaptics 3 for Linux and the Touch Device Driver bring it (3D Systems): run the installers "
    "of both";

}  // namespace

const std::vector<std::string>& OpenHapticsLibrary::names() {
  static const std::vector<std::string> kNames = {"libHD.so.3.4", "libHD.so.3", "libHD.so"};
  return kNames;
}

OpenHapticsLibrary::OpenHapticsLibrary(const std::string& file)
    : library(file.empty() ? names() : std::vector{file}, kBroughtBy) {
  library.find("hdInitDevice", init_device);
  library.find("hdDisableDevice", disable_device);
  library.find("hdMakeCurrentDevice", make_current);
  library.find("hdEnable", enable);
  library.find("hdDisable", disable);
  library.find("hdGetError", get_error);
  library.find("hdGetErrorString", error_name);
  library.find("hdBeginFrame", begin_frame);
  library.find("hdEndFrame", end_frame);
  library.find("hdGetDoublev", get_numbers);
  library.find("hdGetIntegerv", get_integers);
  library.find("hdGetString", get_name);
  library.find("hdSetDoublev", set_numbers);
  library.find("hdCheckCalibration", check_calibration);
  library.find("hdUpdateCalibration", update_calibration);
  library.find("hdStartScheduler", start_scheduler);
  library.find("hdStopScheduler", stop_scheduler);
  library.find("hdScheduleAsynchronous", schedule);
}

unsigned OpenHapticsLibrary::take_errors() const noexcept {
  const unsigned newest = get_error().code;
  unsigned next = newest;
  for (int i = 0; i < kMostErrors && next != hd::kSuccess; ++i) next = get_error().code;
  return newest;
}

std::string OpenHapticsLibrary::words(unsigned code) const {
  const char* told = error_name(code);
  return fmt::format("{}, 0x{:04x}", told == nullptr || *told == '\0' ? "no reason given" : told,
                     code);
}

}  // namespace palpate::device
