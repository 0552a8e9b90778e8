#include "device/forcedimension_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string_view>

#include "base/listed.hpp"
#include "device/drivers.hpp"
#include "device/profile_info.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr double kWatchdogUnit = 125e-6;  // s
constexpr int kStatusPeriod = 50;         // exchanges between looks at the status

// Where the flags lie that dhdGetStatus() fills in, of which newer versions have more.
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
  throw Error(fmt::format("forcedimension:{}: is no device's number; give 0 for the first", text));
}

// The kind that a device's name tells, "omega.7" or "Falcon".
std::string profile_of(std::string title) {
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* known : {"omega", "delta", "sigma", "lambda", "falcon"}) {
    if (title.find(known) != std::string::npos) return known;
  }
  return "unknown";
}

}  // namespace

ForceDimensionLink::ForceDimensionLink(const DeviceName& name)
    : library_(name.option("library", ForceDimensionLibrary::kName)) {
  const int number = number_of(name.device);
  info_.name = fmt::format("forcedimension:{}", number);
  const int count = library_.count();
  if (number >= count) {
    throw Error(
        fmt::format("{}: there is no such device ({} found). Plug it in, switch it on, and let "
                    "your user use it (udev rules; 'palpate doctor' tells)",
                    info_.name, std::max(count, 0)));
  }
  const int id = library_.open(static_cast<char>(number));
  if (id < 0) {
    throw Error(
        fmt::format("{}: cannot be opened ({}). End other programs that use it; let your user use "
                    "it (udev rules; 'palpate doctor' tells)",
                    info_.name, library_.last_words()));
  }
  id_ = static_cast<char>(id);
  const char* told = library_.title(id_);
  const std::string title = told == nullptr ? "" : told;
  try {
    info_ = info_of(device_profile(name.option("profile", profile_of(title))),
                    fmt::format("{} ({})", info_.name, title.empty() ? "no name" : title));
    info_.tells_orientation = library_.has_wrist(id_);
    info_.has_gripper = library_.has_gripper(id_);
    prepare();
  } catch (...) {
    library_.close(id_);
    throw;
  }
}

ForceDimensionLink::~ForceDimensionLink() {
  library_.set_force(0, 0, 0, 0, 0, 0, 0, id_);
  library_.enable_force(0, id_);
  library_.close(id_);
}

void ForceDimensionLink::prepare() {
  check_status();
  library_.enable_expert_mode();
  const int armed =
      library_.set_watchdog(static_cast<unsigned char>(kWatchdog / kWatchdogUnit), id_);
  library_.disable_expert_mode();
  if (armed < 0) info_.name += ", without a watchdog";  // older ones have none
  check(library_.set_force(0, 0, 0, 0, 0, 0, 0, id_), "does not take a force");
  check(library_.enable_force(1, id_), "does not switch its forces on");
}

void ForceDimensionLink::check_status() const {
  std::array<int, Flag::kRoom> flags{};
  flags[Flag::kPower] = 1;
  check(library_.status(flags.data(), id_), "does not tell its status");
  const auto fail = [this](std::string_view words) {
    throw Error(fmt::format("{}: {}", info_.name, words));
  };
  if (flags[Flag::kPower] == 0) fail("has no power. Switch it on, and look at its supply");
  if (flags[Flag::kReset] != 0) {
    fail(
        "is not calibrated. Put its calibration pole into the pit in its base, or run HapticInit "
        "of the maker's SDK");
  }
  if (flags[Flag::kError] != 0) fail("tells an error. Switch it off and on");
  if (flags[Flag::kForce] != 0) return;
  const int cause = flags[Flag::kForceOffCause];
  if (cause == kOffByVelocity && exchanges_ > 0) {
    fail("was moved too fast, so it switched its forces off. It is opened again");
  }
  if (cause == kOffByWatchdog && exchanges_ > 0) {
    fail(
        "was not spoken to for 5 ms, so its watchdog switched its forces off. End what keeps the "
        "computer busy; it is opened again");
  }
}

void ForceDimensionLink::check(int result, const char* what) const {
  if (result >= 0) return;
  throw Error(fmt::format("{}: {} ({}). Look at its cable and its power", info_.name, what,
                          library_.last_words()));
}

LinkReading ForceDimensionLink::exchange(const Vector3d& force) {
  const Vector3d f = to_maker(force);
  check(library_.set_force(f.x(), f.y(), f.z(), 0, 0, 0, 0, id_), "does not take a force");
  Vector3d place;
  check(library_.position(&place.x(), &place.y(), &place.z(), id_), "does not tell its place");
  if (++exchanges_ % kStatusPeriod == 0) check_status();
  return {from_maker(place), velocity(), library_.buttons(id_), orientation(), gripper()};
}

// Tool and base are turned alike: straight stays straight.
Eigen::Quaterniond ForceDimensionLink::orientation() const {
  if (!info_.tells_orientation) return Eigen::Quaterniond::Identity();
  double rows[3][3] = {};
  check(library_.orientation(rows, id_), "does not tell how its tool is held");
  const Eigen::Matrix3d maker =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(*rows);
  Eigen::Matrix3d ours;
  for (int i = 0; i < 3; ++i) ours.col(i) = from_maker(maker * to_maker(Vector3d::Unit(i)));
  return Eigen::Quaterniond(ours).normalized();
}

double ForceDimensionLink::gripper() const {
  double gap = 0;
  if (info_.has_gripper) check(library_.gripper(&gap, id_), "does not tell its gripper's opening");
  return gap;
}

// Velocities are estimated over a window, which has to be filled first.
Vector3d ForceDimensionLink::velocity() {
  Vector3d told = Vector3d::Zero();
  const int result = library_.velocity(&told.x(), &told.y(), &told.z(), id_);
  if (result < 0 && !moves_) return Vector3d::Zero();
  check(result, "does not tell its velocity");
  moves_ = true;
  return from_maker(told);
}

DriverInfo forcedimension_driver() {
  DriverInfo driver{.name = "forcedimension",
                    .description = "Force Dimension omega, delta, sigma, lambda; Novint Falcon",
                    .missing = {},
                    .devices = {}};
  return listed(driver, [](DriverInfo& found) {
    const ForceDimensionLibrary library;
    for (int i = 0; i < library.count(); ++i) {
      found.devices.push_back(
          {fmt::format("forcedimension:{}", i), "its kind is known once it is opened"});
    }
  });
}

std::unique_ptr<DeviceLink> open_forcedimension(const DeviceName& name, const Clock& /*clock*/) {
  check_options(name, {"library", "profile"});
  return std::make_unique<ForceDimensionLink>(name);
}

}  // namespace palpate::device
