#include "device/openhaptics_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "device/drivers.hpp"
#include "device/openhaptics_codes.hpp"
#include "device/profile_info.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr int kCalibrationFrames = 1000;  // until it is calibrated by itself
// Of motors whose device is opened; the maker's own example takes forces back from 0.7 to 0.5.
constexpr double kCool = 0.5;
constexpr const char* kNotCalibrated =
    "is not calibrated. Put its stylus into the inkwell, or calibrate it with the maker's "
    "Touch_Diagnostic (in newer drivers TouchCheckup)";

// What a device's model tells, the most exact first.
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
  for (const TouchModel& known : kTouchModels) {
    if (model.find(known.word) != std::string::npos) return known.profile;
  }
  return "unknown";
}

std::string title_of(const OpenHapticsFacts& facts) {
  const std::string model = facts.model.data();
  const std::string serial_number = facts.serial_number.data();
  return (model.empty() ? "no name" : model) + (serial_number.empty() ? "" : ", ") + serial_number;
}

// What the device tells of itself is better than its kind's profile, unless that was asked for.
DeviceInfo info_of_device(const DeviceName& name, const OpenHapticsFacts& facts,
                          const std::string& device) {
  const std::string title = fmt::format("{} ({})", device, title_of(facts));
  const std::string given = name.option("profile");
  if (!given.empty()) return info_of(device_profile(given), title);
  DeviceInfo info = info_of(device_profile(touch_profile_of(facts.model.data())), title);
  if (facts.continuous_force > 0) info.maximum_force = facts.continuous_force;
  if (facts.maximum_stiffness > 0) info.maximum_stiffness = facts.maximum_stiffness;
  return info;
}

std::string touch_failure(unsigned code, const std::string& told) {
  const std::string off = ", so it switched its forces off (" + told + ")";
  switch (code) {
    case hd::kWarmMotors:
      return "its motors are too warm" + off + ". It is opened again when they have cooled down";
    case hd::kExceededVelocity:
      return "was moved too fast" + off + ". It is opened again";
    case hd::kExceededForce:
    case hd::kExceededImpulse:
    case hd::kForceError:
      return "was to bear too large a force" + off + ". It is opened again";
    case hd::kTimer:
      return "was not spoken to in time (" + told +
             "). End what keeps the computer busy; it is opened again";
    case hd::kDeviceFault:
    case hd::kCommunication:
    case hd::kConfiguration:
      return "does not answer (" + told + "). Look at its cable and its power";
    default:
      return "fails (" + told + "). Look at its cable and its power";
  }
}

}  // namespace

OpenHapticsLink::OpenHapticsLink(const DeviceName& name, const Clock& clock)
    : library_(name.option("library")),
      session_(library_, name.device.empty() ? kDefault : name.device, clock.now()),
      frames_(std::make_shared<OpenHapticsFrames>(library_, session_.device(), clock,
                                                  openhaptics_common())) {
  info_.name = fmt::format("openhaptics:{}", name.device.empty() ? kDefault : name.device);
  try {
    session_.run(frames_);
    (void)exchange(Vector3d::Zero());
    info_ = info_of_device(name, frames_->facts(), info_.name);
    prepare();
  } catch (...) {
    frames_->end(kPatience);
    throw;
  }
}

OpenHapticsLink::~OpenHapticsLink() {
  frames_->end(kPatience);
}

LinkReading OpenHapticsLink::exchange(const Vector3d& force) {
  ask(force);
  return answer();
}

// Its motors are to be cool, and it knows where its hand is, by itself if it can.
void OpenHapticsLink::prepare() {
  OpenHapticsFrames::Answer now = checked_answer();
  const OpenHapticsFacts& facts = frames_->facts();
  if (facts.temperature > kCool) {
    fail(fmt::format("its motors are warm ({:.2f} of 1). Let them cool down to {}",
                     facts.temperature, kCool));
  }
  const bool by_itself = (facts.calibration_styles & (hd::kAutomatic | hd::kInkwell)) != 0;
  if (by_itself && now.calibration == hd::kNeedsUpdate) frames_->calibrate();
  for (int i = 0; i < kCalibrationFrames && by_itself && now.calibration != hd::kCalibrated; ++i) {
    ask(Vector3d::Zero());
    now = checked_answer();
  }
  if (now.calibration != hd::kCalibrated) fail(kNotCalibrated);
}

OpenHapticsFrames::Answer OpenHapticsLink::checked_answer() {
  const std::optional<OpenHapticsFrames::Answer> answer = frames_->answer(kPatience);
  if (!answer) {
    fail(
        "the maker's scheduler does not call any more. Look at its cable, its power, and at what "
        "keeps the computer busy");
  }
  if (answer->failure != hd::kSuccess) {
    fail(touch_failure(answer->failure, library_.words(answer->failure)));
  }
  if (answer->calibration == hd::kNeedsHand) {
    fail(kNotCalibrated);
  }
  return *answer;
}

void OpenHapticsLink::fail(const std::string& words) const {
  throw Error(fmt::format("{}: {}", info_.name, words));
}

}  // namespace palpate::device
