// Checks drivers, USB buses and power of haptic devices and cameras.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

#include "apps/palpate/doctor/checks.hpp"

namespace palpate::app::doctor {

namespace {

constexpr const char* kHapticDevices = "haptic devices";
constexpr int kHaplyPort = 10001;
constexpr const char* kForceDimension =
    "cd sdk-*/ && sudo cp lib/release/lin-x86_64-gcc/libd[hr]d.so.* /usr/local/lib/ && sudo "
    "ldconfig";

constexpr const char* kOpenHaptics = "cd openhaptics*/ && sudo ./install";
constexpr const char* kTouch = "libHD.so";  // how Touch and Phantom are reached

struct VendorLibrary {
  std::string_view name;
  std::array<std::string_view, 2> also_called;  // where that is not installed
  std::string_view devices;                     // that need it: what reaches them
  std::string_view brought_by;
  std::string_view install;  // beside the folder that was unpacked
};

constexpr std::array kLibraries = {
    VendorLibrary{"libdhd.so.3", {}, "libdhd.so.3", "Force Dimension's SDK", kForceDimension},
    VendorLibrary{"libdrd.so.3", {}, "", "Force Dimension's SDK", kForceDimension},
    VendorLibrary{"libHD.so",
                  {"libHD.so.3.4", "libHD.so.3"},
                  kTouch,
                  "3D Systems' OpenHaptics",
                  kOpenHaptics},
};

// The first that loads, else the first that is there and broken.
LibraryTrial tried(const System& system, const VendorLibrary& library) {
  using Outcome = LibraryTrial::Outcome;
  LibraryTrial best = system.try_library(std::string(library.name));
  for (const std::string_view name : library.also_called) {
    if (name.empty() || best.outcome == Outcome::loaded) break;
    LibraryTrial other = system.try_library(std::string(name));
    if (other.outcome == Outcome::loaded || best.outcome == Outcome::absent) {
      best = std::move(other);
    }
  }
  return best;
}

// The command that installs the library which is missing, found in the loader's message
// "libncurses.so.5: cannot open shared object file: ...".
std::string broken_remedy(const VendorLibrary& library, const std::string& words) {
  const std::size_t colon = words.find(": cannot open shared object file");
  const bool plain =
      words.find_first_not_of(
          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.+_-") == colon;
  if (colon == std::string::npos || colon == 0 || !plain) {
    return fmt::format("ldconfig -p | grep {}", library.name);
  }
  return "sudo apt install apt-file && sudo apt-file update && apt-file search " +
         words.substr(0, colon);
}

Answer library_answer(const VendorLibrary& library, const LibraryTrial& trial, bool needed) {
  if (trial.outcome == LibraryTrial::Outcome::loaded) {
    return good(trial.words.empty() ? "loaded; its C interface reports no version"
                                    : "loaded, version " + trial.words);
  }
  if (trial.outcome == LibraryTrial::Outcome::broken) {
    return {needed ? Severity::problem : Severity::warning, "does not load: " + trial.words,
            broken_remedy(library, trial.words)};
  }
  return {needed ? Severity::problem : Severity::note,
          fmt::format(
              "not found; it is part of {} (unpack that, then run this command next to its folder)",
              library.brought_by),
          std::string(library.install)};
}

// OpenHaptics opens what the maker's set-up has written into a file NAME.config.
Answer touch_setup(const Machine& machine) {
  const std::string given = variable(machine.system, "GTDD_HOME");
  const std::filesystem::path folder =
      std::filesystem::path(given.empty() ? variable(machine.system, "HOME") + "/.3dsystems"
                                          : given) /
      "config";
  std::vector<std::string> names;
  for (const auto& entry : entries(machine.system.root / folder.relative_path())) {
    if (entry.extension() == ".config") names.push_back(entry.stem().string());
  }
  if (!names.empty()) {
    return good(fmt::format("{} in {}", fmt::join(names, ", "), folder.string()));
  }
  return problem(fmt::format("no device is configured in {}, so OpenHaptics cannot open one (newer "
                             "drivers call the tool Touch_HeadlessSetup)",
                             folder.string()),
                 fmt::format("{}mkdir -p \"$GTDD_HOME/config\" && Touch_Setup",
                             given.empty() ? "export GTDD_HOME=\"$HOME/.3dsystems\" && " : ""));
}

Answer haply_service(const Machine& machine) {
  if (machine.system.listens(kHaplyPort)) {
    return good(fmt::format("answers on 127.0.0.1:{}", kHaplyPort));
  }
  return {
      any_reached_by("service", machine.devices) ? Severity::problem : Severity::note,
      fmt::format("no answer on 127.0.0.1:{}; Haply's installer provides the service", kHaplyPort),
      "sudo systemctl enable --now haply-inverse-service"};
}

constexpr const char* kCameras = "cameras";

// Drivers of hardware; those that simulate or play are always there.
struct DriverPackages {
  std::string_view driver;
  std::string_view build;    // what a build needs to have the driver
  std::string_view running;  // what a build with it needs
};

constexpr std::array kPackages = {
    DriverPackages{"openni2", "libopenni2-dev", "libopenni2-0"},
    DriverPackages{"freenect", "libfreenect-dev", "libfreenect0.5"},
};

std::string reinstall(const DriverPackages& packages) {
  return fmt::format("sudo apt install --reinstall {}", packages.running);
}

std::string remedy_for(const System& system, const DriverInfo& driver,
                       const DriverPackages& packages) {
  if (driver.missing.find("this build") != std::string::npos) {
    return fmt::format("sudo apt install {} && cmake --preset release && ninja -C build/release",
                       packages.build);
  }
  return driver.missing.find("USB") == std::string::npos ? reinstall(packages)
                                                         : usb_command(system);
}

Answer driver_answer(const Machine& machine, const DriverInfo& driver,
                     const DriverPackages& packages) {
  const bool plugged = any_reached_by(driver.name, machine.devices);
  if (!driver.available) {
    return {plugged ? Severity::problem : Severity::note, driver.missing,
            remedy_for(machine.system, driver, packages)};
  }
  if (driver.devices.empty() && plugged) {
    return problem("a camera for it is plugged in, but the driver does not find it",
                   reinstall(packages));
  }
  return good(fmt::format("available, {} found", driver.devices.size()));
}

// A driver that is missing is a problem where a camera for it is plugged in.
void check_drivers(const Machine& machine, Findings& findings) {
  for (const DriverInfo& driver : machine.cameras) {
    const auto* const packages = std::ranges::find(kPackages, driver.name, &DriverPackages::driver);
    if (packages == kPackages.end()) continue;
    findings.push_back(
        {driver_answer(machine, driver, *packages), kCameras, "driver " + driver.name});
  }
  for (const auto& [device, model] : machine.devices) {
    if (model.kind != DeviceKind::camera || !model.reached_by.empty()) continue;
    findings.push_back(
        {note(fmt::format("palpate has no driver for {}; record it as depth images", model.name),
              "palpate touch sequence:FOLDER"),
         kCameras, "driver"});
  }
}

void check_shared_buses(const Machine& machine, Findings& findings) {
  std::map<long, int> cameras;
  for (const auto& [device, model] : machine.devices) {
    if (model.kind == DeviceKind::camera) ++cameras[device.bus];
  }
  for (const auto& [bus, count] : cameras) {
    if (count < 2) continue;
    findings.push_back({warning(fmt::format("{} cameras share bus {}: frames may be lost; plug "
                                            "them into ports of different controllers",
                                            count, bus),
                                "lsusb -t"),
                        kCameras, "USB bandwidth"});
  }
}

// A Kinect without its own power supply shows its motor or microphones, and no camera.
void check_power(const Machine& machine, Findings& findings) {
  const bool parts = std::ranges::any_of(machine.devices, [](const KnownUsbDevice& each) {
    return each.model.kind == DeviceKind::part;
  });
  if (!parts || any_reached_by("freenect", machine.devices)) return;
  findings.push_back({problem("a Kinect is connected, but its camera is missing: plug in its power "
                              "supply, then check again",
                              "lsusb -d 045e:"),
                      kCameras, "Kinect v1"});
}

}  // namespace

// A library's absence is a problem where a device needs it.
void check_haptic_devices(const Machine& machine, Findings& findings) {
  check_usb(machine, DeviceKind::haptic, kHapticDevices, findings);
  for (const VendorLibrary& library : kLibraries) {
    const bool needed =
        !library.devices.empty() && any_reached_by(library.devices, machine.devices);
    findings.push_back({library_answer(library, tried(machine.system, library), needed),
                        kHapticDevices, std::string(library.name)});
  }
  if (any_reached_by(kTouch, machine.devices)) {
    findings.push_back({touch_setup(machine), kHapticDevices, "Touch's set-up"});
  }
  findings.push_back({haply_service(machine), kHapticDevices, "Haply's Inverse Service"});
}

void check_cameras(const Machine& machine, Findings& findings) {
  check_usb(machine, DeviceKind::camera, kCameras, findings);
  check_power(machine, findings);
  check_shared_buses(machine, findings);
  check_drivers(machine, findings);
}

}  // namespace palpate::app::doctor
