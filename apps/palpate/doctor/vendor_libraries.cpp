#include "apps/palpate/doctor/vendor_libraries.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

namespace palpate::app::doctor {

namespace {

constexpr const char* kVendors = "haptic devices";
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

// Of "libncurses.so.5: cannot open shared object file: ...": the library that is missing.
std::string missing_library(const std::string& words) {
  const std::size_t colon = words.find(": cannot open shared object file");
  const bool plain =
      words.find_first_not_of(
          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.+_-") == colon;
  return colon != std::string::npos && plain ? words.substr(0, colon) : "";
}

Finding checked(const VendorLibrary& library, const LibraryTrial& trial, bool needed) {
  Finding finding{kVendors, std::string(library.name)};
  switch (trial.outcome) {
    case LibraryTrial::Outcome::loaded:
      finding.words = trial.words.empty() ? "loaded; its C interface tells no version"
                                          : "loaded, version " + trial.words;
      break;
    case LibraryTrial::Outcome::absent:
      finding.severity = needed ? Severity::problem : Severity::note;
      finding.words =
          fmt::format("not found; {} brings it (unpack it, then install it from beside its folder)",
                      library.brought_by);
      finding.remedy = library.install;
      break;
    case LibraryTrial::Outcome::broken: {
      finding.severity = needed ? Severity::problem : Severity::warning;
      finding.words = "does not load: " + trial.words;
      const std::string missing = missing_library(trial.words);
      finding.remedy =
          missing.empty()
              ? fmt::format("ldconfig -p | grep {}", library.name)
              : "sudo apt install apt-file && sudo apt-file update && apt-file search " + missing;
      break;
    }
  }
  return finding;
}

// The first that loads, else the first that is there and broken.
LibraryTrial tried(const System& system, const VendorLibrary& library) {
  LibraryTrial best = system.try_library(std::string(library.name));
  for (const std::string_view name : library.also_called) {
    if (name.empty() || best.outcome == LibraryTrial::Outcome::loaded) break;
    LibraryTrial other = system.try_library(std::string(name));
    const bool better = other.outcome == LibraryTrial::Outcome::loaded ||
                        best.outcome == LibraryTrial::Outcome::absent;
    if (better) best = std::move(other);
  }
  return best;
}

// OpenHaptics opens what the maker's set-up has written into a file NAME.config.
Finding check_touch_setup(const System& system) {
  const std::string given = variable(system, "GTDD_HOME");
  const std::filesystem::path folder =
      std::filesystem::path(given.empty() ? variable(system, "HOME") + "/.3dsystems" : given) /
      "config";
  std::string names;
  for (const auto& entry : entries(system.root / folder.relative_path())) {
    if (entry.extension() == ".config") {
      names += (names.empty() ? "" : ", ") + entry.stem().string();
    }
  }
  Finding finding{kVendors, "Touch's set-up"};
  finding.words = fmt::format("{} in {}", names, folder.string());
  if (!names.empty()) return finding;
  finding.severity = Severity::problem;
  finding.words = fmt::format(
      "no device is set up in {}: OpenHaptics opens none that is not (newer drivers "
      "call the tool Touch_HeadlessSetup)",
      folder.string());
  finding.remedy = fmt::format("{}mkdir -p \"$GTDD_HOME/config\" && Touch_Setup",
                               given.empty() ? "export GTDD_HOME=\"$HOME/.3dsystems\" && " : "");
  return finding;
}

Finding check_haply(const System& system, bool needed) {
  Finding finding{kVendors, "Haply's Inverse Service"};
  if (system.listens(kHaplyPort)) {
    finding.words = fmt::format("answers on 127.0.0.1:{}", kHaplyPort);
    return finding;
  }
  finding.severity = needed ? Severity::problem : Severity::note;
  finding.words =
      fmt::format("nobody answers on 127.0.0.1:{}; Haply's installer brings it", kHaplyPort);
  finding.remedy = "sudo systemctl enable --now haply-inverse-service";
  return finding;
}

}  // namespace

Findings check_vendor_libraries(const System& system, const std::vector<Found>& found) {
  Findings findings;
  for (const VendorLibrary& library : kLibraries) {
    const bool needed = !library.devices.empty() && reaches_any(library.devices, found);
    findings.push_back(checked(library, tried(system, library), needed));
  }
  if (reaches_any(kTouch, found)) findings.push_back(check_touch_setup(system));
  findings.push_back(check_haply(system, reaches_any("service", found)));
  return findings;
}

}  // namespace palpate::app::doctor
