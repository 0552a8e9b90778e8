// Force Dimension's devices and the Novint Falcon, through the maker's library.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string_view>

#include "base/shared_library.hpp"
#include "device/drivers.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr double kWatchdog = 5e-3;        // s without a call after which the device drops its force
constexpr double kWatchdogUnit = 125e-6;  // s
constexpr int kStatusPeriod = 50;         // exchanges from one check of the status to the next

// Indices of what dhdGetStatus() fills in; newer versions have more.
struct Flag {
  static constexpr std::size_t kPower = 0;
  static constexpr std::size_t kReset = 3;  // it waits to be calibrated
  static constexpr std::size_t kForce = 5;  // forces are on
  static constexpr std::size_t kError = 9;
  static constexpr std::size_t kForceOffCause = 14;
  static constexpr std::size_t kRoom = 64;
};
constexpr int kOffByVelocity = 2;
constexpr int kOffByWatchdog = 3;

// The part of the maker's C interface (SDK 3) that is used here. All numbers in metres, newtons,
// seconds; results below 0 are errors, above 0 notes.
struct ForceDimensionLibrary {
  static constexpr const char* kName = "libdhd.so.3";

  // Throws Error that states what is missing.
  explicit ForceDimensionLibrary(const std::string& file = kName)
      : library({file},
                "It is part of Force Dimension's SDK 3 for Linux (forcedimension.com): copy it to "
                "/usr/local/lib and run ldconfig; 'palpate doctor' shows what is missing",
                SharedLibrary::Unload::never) {}

  // The last error in this thread.
  [[nodiscard]] std::string error_text() const {
    const char* text = last_error();
    return text == nullptr || *text == '\0' ? "no reason given" : text;
  }

  SharedLibrary library;
  int (*count)() = library["dhdGetDeviceCount"];  // of devices, those in use too
  int (*open)(char index) = library["dhdOpenID"];
  int (*close)(char id) = library["dhdClose"];
  const char* (*title)(char id) = library["dhdGetSystemName"];
  int (*status)(int* flags, char id) = library["dhdGetStatus"];
  int (*enable_force)(unsigned char on, char id) = library["dhdEnableForce"];
  int (*enable_expert_mode)() = library["dhdEnableExpertMode"];
  int (*disable_expert_mode)() = library["dhdDisableExpertMode"];
  int (*set_watchdog)(unsigned char duration, char id) = library["dhdSetWatchdog"];  // in 125 us
  int (*position)(double* x, double* y, double* z, char id) = library["dhdGetPosition"];
  int (*velocity)(double* x, double* y, double* z, char id) = library["dhdGetLinearVelocity"];
  unsigned (*buttons)(char id) = library["dhdGetButtonMask"];
  bool (*has_wrist)(char id) = library["dhdHasWrist"];
  bool (*has_gripper)(char id) = library["dhdHasGripper"];
  // From the tool's axes to the base's.
  int (*orientation)(double rows[3][3], char id) = library["dhdGetOrientationFrame"];
  int (*gripper)(double* gap, char id) = library["dhdGetGripperGap"];
  int (*set_force)(double x, double y, double z, double around_x, double around_y, double around_z,
                   double gripper, char id) = library["dhdSetForceAndTorqueAndGripperForce"];
  const char* (*last_error)() = library["dhdErrorGetLastStr"];
  // Older versions lack these; then no torque is rendered.
  bool (*has_active_wrist)(char id) = library.find("dhdHasActiveWrist");
  bool (*has_active_gripper)(char id) = library.find("dhdHasActiveGripper");
  int (*angular_velocity)(double* x, double* y, double* z,
                          char id) = library.find("dhdGetAngularVelocityRad");  // base's axes
};

// The maker's x is towards the operator, y to the right, z up.
Vector3d from_maker(const Vector3d& v) {
  return {v.y(), -v.x(), v.z()};
}
Vector3d to_maker(const Vector3d& v) {
  return {-v.y(), v.x(), v.z()};
}

int number_of(const std::string& text) {
  int number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  const bool good = error == std::errc{} && stop == end && number >= 0 && number < 64;
  if (text.empty() || good) return number;
  throw Error(fmt::format("forcedimension:{}: not a device number; give 0 for the first", text));
}

// The kind in a device's name, such as "omega.7" or "Falcon".
std::string profile_of(std::string title) {
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* each : {"omega", "delta", "sigma", "lambda", "falcon"}) {
    if (title.find(each) != std::string::npos) return each;
  }
  return "unknown";
}

// Arms the device's own watchdog and leaves its velocity threshold alone. Wrists and grippers get a
// torque and a force where they have motors. A grip above 0 is taken to open the fingers, as the
// gap that it goes with does; the maker does not say.
class ForceDimensionDriver final : public DeviceDriver {
 public:
  explicit ForceDimensionDriver(const DeviceName& name)
      : library_(name.option("library", ForceDimensionLibrary::kName)) {
    const int number = number_of(name.device);
    info_.name = fmt::format("forcedimension:{}", number);
    open(number);
    const char* reported = library_.title(id_);
    const std::string title = reported == nullptr ? "" : reported;
    try {
      const DeviceProfile profile = device_profile(name.option("profile", profile_of(title)));
      info_ =
          info_of(profile, fmt::format("{} ({})", info_.name, title.empty() ? "no name" : title));
      info_.has_orientation = library_.has_wrist(id_);
      info_.has_gripper = library_.has_gripper(id_);
      add_motors(info_, profile, has_motors_of_wrist(), has_motor_of_gripper());
      prepare();
    } catch (...) {
      library_.close(id_);
      throw;
    }
  }
  ~ForceDimensionDriver() override {
    library_.set_force(0, 0, 0, 0, 0, 0, 0, id_);
    library_.enable_force(0, id_);
    library_.close(id_);
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState exchange(const Vector3d& force) override {
    return exchange_wrench({.force = force});
  }
  [[nodiscard]] DeviceState exchange_wrench(const Wrench& wrench) override {
    const Vector3d f = to_maker(wrench.force);
    const Vector3d t = to_maker(wrench.torque);
    check(library_.set_force(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), wrench.grip, id_),
          "does not accept a force");
    Vector3d position;
    check(library_.position(&position.x(), &position.y(), &position.z(), id_),
          "does not report its position");
    if (++exchanges_ % kStatusPeriod == 0) check_status();
    return {.position = from_maker(position),
            .velocity = velocity(),
            .buttons = library_.buttons(id_),
            .orientation = orientation(),
            .gripper = gripper(),
            .angular_velocity = angular_velocity()};
  }

 private:
  [[nodiscard]] bool has_motors_of_wrist() const {
    return info_.has_orientation && library_.angular_velocity != nullptr &&
           library_.has_active_wrist != nullptr && library_.has_active_wrist(id_);
  }
  [[nodiscard]] bool has_motor_of_gripper() const {
    return info_.has_gripper && library_.has_active_gripper != nullptr &&
           library_.has_active_gripper(id_);
  }

  void open(int number) {
    const int count = library_.count();
    if (number >= count) {
      fail(
          fmt::format("no such device ({} found). Plug it in, switch it on, and give your user "
                      "access (udev rules; 'palpate doctor' explains)",
                      std::max(count, 0)));
    }
    const int id = library_.open(static_cast<char>(number));
    if (id < 0) {
      fail(
          fmt::format("cannot be opened ({}). Close other programs that use it; give your user "
                      "access (udev rules; 'palpate doctor' explains)",
                      library_.error_text()));
    }
    id_ = static_cast<char>(id);
  }

  void prepare() {
    check_status();
    library_.enable_expert_mode();
    const int armed =
        library_.set_watchdog(static_cast<unsigned char>(kWatchdog / kWatchdogUnit), id_);
    library_.disable_expert_mode();
    if (armed < 0) info_.name += ", without a watchdog";  // older ones have none
    check(library_.set_force(0, 0, 0, 0, 0, 0, 0, id_), "does not accept a force");
    check(library_.enable_force(1, id_), "does not enable its forces");
  }

  void check_status() const {
    std::array<int, Flag::kRoom> flags{};
    flags[Flag::kPower] = 1;
    check(library_.status(flags.data(), id_), "does not report its status");
    if (flags[Flag::kPower] == 0) fail("has no power. Switch it on and check its power supply");
    if (flags[Flag::kReset] != 0) {
      fail(
          "is not calibrated. Put its calibration pole into the pit in its base, or run HapticInit "
          "from the vendor's SDK");
    }
    if (flags[Flag::kError] != 0) fail("reports an error. Switch it off and on");
    if (flags[Flag::kForce] != 0) return;
    const int cause = flags[Flag::kForceOffCause];
    if (cause == kOffByVelocity && exchanges_ > 0) {
      fail("was moved too fast, so it disabled its forces. It will be reopened");
    }
    if (cause == kOffByWatchdog && exchanges_ > 0) {
      fail(
          "received nothing for 5 ms, so its watchdog disabled its forces. Close programs that "
          "keep the computer busy; the device will be reopened");
    }
  }

  void check(int result, const char* what) const {
    if (result >= 0) return;
    fail(fmt::format("{} ({}). Check its cable and power", what, library_.error_text()));
  }

  [[noreturn]] void fail(std::string_view words) const {
    throw Error(fmt::format("{}: {}", info_.name, words));
  }

  using Estimate = int (*)(double* x, double* y, double* z, char id);

  // The maker estimates velocities over a window, which has to be filled first.
  [[nodiscard]] Vector3d estimated(Estimate estimate, bool& filled) const {
    Vector3d reported = Vector3d::Zero();
    const int result = estimate(&reported.x(), &reported.y(), &reported.z(), id_);
    if (result < 0 && !filled) return Vector3d::Zero();
    check(result, "does not report its velocity");
    filled = true;
    return from_maker(reported);
  }
  [[nodiscard]] Vector3d velocity() { return estimated(library_.velocity, has_velocity_); }
  [[nodiscard]] Vector3d angular_velocity() {
    if (info_.maximum_torque == 0) return Vector3d::Zero();
    return estimated(library_.angular_velocity, has_angular_velocity_);
  }

  // Tool and base are rotated alike: straight stays straight.
  [[nodiscard]] Eigen::Quaterniond orientation() const {
    if (!info_.has_orientation) return Eigen::Quaterniond::Identity();
    double rows[3][3] = {};
    check(library_.orientation(rows, id_), "does not report its orientation");
    const Eigen::Matrix3d maker =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(*rows);
    Eigen::Matrix3d ours;
    for (int i = 0; i < 3; ++i) ours.col(i) = from_maker(maker * to_maker(Vector3d::Unit(i)));
    return Eigen::Quaterniond(ours).normalized();
  }

  [[nodiscard]] double gripper() const {
    double gap = 0;
    if (info_.has_gripper) check(library_.gripper(&gap, id_), "does not report its gripper");
    return gap;
  }

  ForceDimensionLibrary library_;
  DeviceInfo info_;
  char id_ = -1;
  bool has_velocity_ = false;
  bool has_angular_velocity_ = false;
  std::uint64_t exchanges_ = 0;  // since it was opened
};

}  // namespace

DriverInfo list_forcedimension() {
  DriverInfo driver{.name = "forcedimension",
                    .description = "Force Dimension omega, delta, sigma, lambda; Novint Falcon"};
  return listed(driver, [](DriverInfo& found) {
    const ForceDimensionLibrary library;
    for (int i = 0; i < library.count(); ++i) {
      found.devices.push_back(
          {fmt::format("forcedimension:{}", i), "its model is known once it is opened"});
    }
  });
}

std::unique_ptr<DeviceDriver> open_forcedimension(const DeviceName& name, const Clock& /*clock*/) {
  check_options(name, {"library", "profile"});
  return std::make_unique<ForceDimensionDriver>(name);
}

}  // namespace palpate::device
