// Drives 3D Systems' Touch devices through OpenHaptics.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/shared_library.hpp"
#include "device/openhaptics_scheduler.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

constexpr int kCalibrationFrames = 1000;  // until it is calibrated by itself
// Motors of a device that is opened have to be this cool; the maker's own example reduces forces
// from 0.7 to 0.5.
constexpr double kCool = 0.5;
constexpr const char* kNotCalibrated =
    "is not calibrated. Put its stylus into the inkwell, or calibrate it with the vendor's "
    "Touch_Diagnostic (TouchCheckup in newer drivers)";

// Maps a word in the model's name to a profile; the first match wins, so exact words come first.
struct TouchModel {
  std::string_view word;
  const char* profile;
};
constexpr std::array kTouchModels = {
    TouchModel{"touch x", "touch-x"},
    TouchModel{"touch", "touch"},
    TouchModel{"omni", "phantom-omni"},
    TouchModel{"desktop", "phantom-desktop"},
    TouchModel{"premium 1.5", "phantom-premium-1.5"},
    TouchModel{"premium 3.0", "phantom-premium-3.0"},
};

std::string touch_profile_of(std::string model) {
  std::ranges::transform(model, model.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const TouchModel& each : kTouchModels) {
    if (model.find(each.word) != std::string::npos) return each.profile;
  }
  return "unknown";
}

std::string title_of(const OpenHapticsFacts& facts) {
  return (facts.model.empty() ? "no name" : facts.model) +
         (facts.serial_number.empty() ? "" : ", ") + facts.serial_number;
}

// The library may tell a torque of devices that have no motors for it.
bool has_six_motors(const OpenHapticsFacts& facts) {
  std::string model = facts.model;
  std::ranges::transform(model, model.begin(), [](unsigned char c) { return std::tolower(c); });
  return facts.continuous_torque > 0 && model.find("6dof") != std::string::npos;
}

// Prefers the device's own report to its kind's profile, unless the user asked for a profile.
DeviceInfo info_of_device(const DeviceName& name, const OpenHapticsFacts& facts,
                          const std::string& device) {
  const std::string title = fmt::format("{} ({})", device, title_of(facts));
  const std::string given = name.option("profile");
  if (!given.empty()) {
    DeviceInfo info = info_of(device_profile(given), title);
    info.has_orientation = true;
    add_motors(info, device_profile(given), has_six_motors(facts), false);
    return info;
  }
  DeviceInfo info = info_of(device_profile(touch_profile_of(facts.model)), title);
  info.has_orientation = true;
  if (facts.continuous_force > 0) info.maximum_force = facts.continuous_force;
  if (facts.maximum_stiffness > 0) info.maximum_stiffness = facts.maximum_stiffness;
  if (has_six_motors(facts)) info.maximum_torque = facts.continuous_torque;
  return info;
}

std::string touch_failure(unsigned code, const std::string& report) {
  const std::string off = ", so it disabled its forces (" + report + ")";
  switch (code) {
    case hd::kWarmMotors:
      return "its motors are too hot" + off + ". It will be reopened once they have cooled down";
    case hd::kExceededVelocity:
      return "was moved too fast" + off + ". It will be reopened";
    case hd::kExceededForce:
    case hd::kExceededImpulse:
    case hd::kForceError:
      return "was sent too large a force" + off + ". It will be reopened";
    case hd::kTimer:
      return "received no frame in time (" + report +
             "). Close programs that keep the computer busy; the device will be reopened";
    case hd::kDeviceFault:
    case hd::kCommunication:
    case hd::kConfiguration:
      return "does not answer (" + report + "). Check its cable and power";
    default:
      return "fails (" + report + "). Check its cable and power";
  }
}

// Folder where the maker's drivers keep NAME.config for each device.
fs::path touch_configurations() {
  const char* given = std::getenv("GTDD_HOME");
  if (given != nullptr && *given != '\0') return fs::path(given) / "config";
  const char* home = std::getenv("HOME");
  return fs::path(home == nullptr ? "" : home) / ".3dsystems" / "config";
}

}  // namespace

OpenHapticsDriver::OpenHapticsDriver(const DeviceName& name, const Clock& clock)
    : library_(name.option("library")),
      session_(library_, name.device.empty() ? kDefault : name.device, clock) {
  info_.name = fmt::format("openhaptics:{}", name.device.empty() ? kDefault : name.device);
  (void)exchange(Vector3d::Zero());
  info_ = info_of_device(name, session_.facts(), info_.name);
  if (info_.maximum_torque > 0) session_.frames().enable_torque();
  prepare();
}

DeviceState OpenHapticsDriver::exchange_wrench(const Wrench& wrench) {
  request(wrench);
  return answer();
}

// Its motors have to be cool, and it is calibrated, automatically if it can be.
void OpenHapticsDriver::prepare() {
  OpenHapticsFrames::Answer now = checked_answer();
  if (now.temperature > kCool) {
    fail(fmt::format("its motors are hot ({:.2f} of 1). Let them cool down to {}", *now.temperature,
                     kCool));
  }
  const int styles = session_.facts().calibration_styles & (hd::kAutomatic | hd::kInkwell);
  if (styles != 0 && now.calibration == hd::kNeedsUpdate) session_.frames().calibrate(styles);
  for (int i = 0; i < kCalibrationFrames && styles != 0 && now.calibration != hd::kCalibrated;
       ++i) {
    request({});
    now = checked_answer();
  }
  if (now.calibration != hd::kCalibrated) fail(kNotCalibrated);
}

OpenHapticsFrames::Answer OpenHapticsDriver::checked_answer() {
  const std::optional<OpenHapticsFrames::Answer> answer = session_.frames().answer(kPatience);
  if (!answer) {
    const unsigned error = session_.take_error();
    fail(
        fmt::format("the vendor's scheduler is not running{}. Check the cable, the power, and what "
                    "keeps the computer busy",
                    error == hd::kSuccess ? "" : fmt::format(" ({})", library_.describe(error))));
  }
  if (answer->failure != hd::kSuccess) {
    fail(touch_failure(answer->failure, library_.describe(answer->failure)));
  }
  if (answer->calibration == hd::kNeedsHand) fail(kNotCalibrated);
  return *answer;
}

void OpenHapticsDriver::fail(const std::string& words) const {
  throw Error(fmt::format("{}: {}", info_.name, words));
}

DriverInfo list_openhaptics() {
  DriverInfo driver{.name = "openhaptics",
                    .description =
                        "3D Systems Touch, Touch X; SensAble Phantom Omni, Desktop, "
                        "Premium"};
  return listed(driver, [](DriverInfo& found) {
    const OpenHapticsLibrary library;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(touch_configurations(), none)) {
      if (entry.path().extension() != ".config") continue;
      found.devices.push_back({"openhaptics:" + entry.path().stem().string(),
                               "as set up in " + touch_configurations().string()});
    }
    std::ranges::sort(found.devices, {}, &DriverInfo::Device::name);
  });
}

std::unique_ptr<DeviceDriver> open_openhaptics(const DeviceName& name, const Clock& clock) {
  check_options(name, {"library", "profile"});
  return std::make_unique<OpenHapticsDriver>(name, clock);
}

}  // namespace palpate::device
