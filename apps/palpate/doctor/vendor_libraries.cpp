#include "apps/palpate/doctor/vendor_libraries.hpp"

#include <fmt/format.h>

#include <array>

namespace palpate::app::doctor {

namespace {

constexpr const char* kVendors = "haptic devices";
constexpr int kHaplyPort = 10001;
constexpr const char* kForceDimension =
    "cd sdk-*/ && sudo cp lib/release/lin-x86_64-gcc/libd[hr]d.so.* /usr/local/lib/ && sudo "
    "ldconfig";

constexpr const char* kOpenHaptics = "cd openhaptics*/ && sudo ./install";

struct VendorLibrary {
  std::string_view name;
  std::string_view devices;  // that need it: what reaches them
  std::string_view brought_by;
  std::string_view install;  // beside the folder that was unpacked
};

constexpr std::array kLibraries = {
    VendorLibrary{"libdhd.so.3", "libdhd.so.3", "Force Dimension's SDK", kForceDimension},
    VendorLibrary{"libdrd.so.3", "", "Force Dimension's SDK", kForceDimension},
    VendorLibrary{"libHD.so", "libHD.so", "3D Systems' OpenHaptics", kOpenHaptics},
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
    findings.push_back(checked(library, system.try_library(std::string(library.name)), needed));
  }
  findings.push_back(check_haply(system, reaches_any("service", found)));
  return findings;
}

}  // namespace palpate::app::doctor
