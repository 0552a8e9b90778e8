// The doctor's checks and their findings.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/palpate/doctor/system.hpp"

namespace CLI {
class App;
}

namespace palpate::app::doctor {

/// A device on USB, as the kernel lists in /sys/bus/usb/devices.
struct UsbDevice {
  std::string path;        ///< "1-4.2"
  std::string vendor;      ///< "045e"
  std::string product;     ///< "02ae"
  std::string title = {};  ///< what the device calls its maker and itself: may be anything
  long bus = 0;
  long number = 0;                          ///< on the bus
  std::vector<std::string> drivers = {};    ///< the kernel's, of its interfaces
  std::vector<std::string> terminals = {};  ///< "ttyACM0"
};

enum class DeviceKind {
  haptic,
  camera,
  part,  ///< of a camera: a motor, microphones
};

/// A model of device, and how programs reach it.
struct DeviceModel {
  std::string_view name;
  DeviceKind kind;
  /// A driver of `palpate cameras` or a vendor's library; "service": Haply's; empty: none.
  std::string_view reached_by;
  std::string_view rival;  ///< a driver of the kernel that takes it away; empty: none
};

/// A device that is plugged in and whose model palpate lists.
struct KnownUsbDevice {
  UsbDevice device;
  DeviceModel model;
};

/// Known devices that are plugged in, sorted by their path on the bus.
[[nodiscard]] std::vector<KnownUsbDevice> known_usb_devices(const System& system);

/// Is one there that is reached by this driver or library?
[[nodiscard]] bool any_reached_by(std::string_view driver,
                                  const std::vector<KnownUsbDevice>& devices);

/// How much a finding hinders a run, from nothing on.
enum class Severity {
  good,
  note,     ///< something is absent that not everybody needs
  warning,  ///< it works, but perhaps late or not for every program
  problem,  ///< something that is there does not work
};

/// The answer to one check's question.
struct Answer {
  Severity severity = Severity::good;
  std::string words = {};               ///< what was found and what that means
  std::string remedy = {};              ///< the command that mends it; empty where all is good
  std::vector<std::string> lines = {};  ///< more to look at, such as a histogram
};

inline Answer good(std::string words) {
  return {Severity::good, std::move(words)};
}
inline Answer note(std::string words, std::string remedy) {
  return {Severity::note, std::move(words), std::move(remedy)};
}
inline Answer warning(std::string words, std::string remedy) {
  return {Severity::warning, std::move(words), std::move(remedy)};
}
inline Answer problem(std::string words, std::string remedy) {
  return {Severity::problem, std::move(words), std::move(remedy)};
}

struct Finding : Answer {
  std::string area;       ///< "kernel"
  std::string looked_at;  ///< "clock source"
};
using Findings = std::vector<Finding>;

/// Input of all checks, measured and listed once.
struct Machine {
  const System& system;
  RealtimeTrial trial;
  std::vector<KnownUsbDevice> devices;
  std::vector<DriverInfo> cameras;
};

/// A row of an area's table: what it looks at and how it answers.
struct Check {
  const char* area;
  const char* what;
  Answer (*question)(const Machine&);
};

/// The answers to a table's questions are appended to `findings`.
void run_checks(std::span<const Check> checks, const Machine& machine, Findings& findings);

// One function an area; each appends to `findings`.

/// Does the kernel let a servo's thread run in time, and is the thread permitted what it requests?
void check_kernel(const Machine& machine, Findings& findings);
/// Haptic devices on USB, and the vendors' libraries and services that reach them.
void check_haptic_devices(const Machine& machine, Findings& findings);
/// Depth cameras on USB, and the drivers of `palpate cameras`.
void check_cameras(const Machine& machine, Findings& findings);
/// What lets ROS 2's nodes and palpate see one another: middleware, domain, range, buffers.
void check_ros(const Machine& machine, Findings& findings);
/// Files, locale, pictures, browser.
void check_surroundings(const Machine& machine, Findings& findings);

/// What is plugged in of one kind: may this user open it, does a driver of the kernel hold it?
void check_usb(const Machine& machine, DeviceKind kind, const char* area, Findings& findings);
/// Are palpate's rules where udev reads them, put there by a package or a command of the doctor's?
[[nodiscard]] bool has_rules(const System& system);
/// The command that lets this user open devices on USB: from within a container, where the kernel
/// has no USB, or by rules for udev.
[[nodiscard]] std::string usb_command(const System& system);

/// Every check, area by area. `jitter`: s to measure for; 0 leaves that out.
[[nodiscard]] Findings check_all(const System& system, double jitter);

/// The worst of them; good when there are none.
[[nodiscard]] Severity worst(const Findings& findings);

/// Findings for people: area by area, what mends each below it, how many there are at the end.
void print(const Findings& findings, std::FILE* stream);

/// The same as a list; each has the keys area, looked_at, severity, words, remedy and lines.
[[nodiscard]] nlohmann::ordered_json as_json(const Findings& findings);

}  // namespace palpate::app::doctor

namespace palpate::app {

/// The command line of `palpate doctor`.
struct DoctorOptions {
  double jitter = 2;  ///< s to measure for; 0: not at all
  std::string json;
};

void add_doctor_options(CLI::App& command, DoctorOptions& options);

/// `palpate doctor`. Returns the exit code: 0, 1 or 3. @throws Error.
[[nodiscard]] int examine(const DoctorOptions& options);

}  // namespace palpate::app
