// Loads OpenHaptics at run time and assigns its errors to devices.
#include "device/openhaptics_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate::device {
namespace {

constexpr double kLengthUnit = 1e-3;  // m; OpenHaptics measures in mm (the maker's)
constexpr double kTorqueUnit = 1e-3;  // N m; OpenHaptics measures in mN m (the maker's)
constexpr const char* kBroughtBy =
    "It is part of OpenHaptics 3 for Linux and the Touch Device Driver (3D Systems): run the "
    "installers of both; 'palpate doctor' shows what is missing";

// The most exact first.
std::vector<std::string> names_of(const std::string& file) {
  if (!file.empty()) return {file};
  return {"libHD.so.3.4", "libHD.so.3", "libHD.so"};
}

double positive_or_zero(double number) {
  return std::isfinite(number) && number > 0 ? number : 0;
}

std::string text_or_empty(const char* text) {
  return text == nullptr ? "" : text;
}

}  // namespace

OpenHapticsLibrary::OpenHapticsLibrary(const std::string& file)
    : library(names_of(file), kBroughtBy, SharedLibrary::Unload::never) {}

unsigned OpenHapticsLibrary::take_errors() const noexcept {
  const unsigned newest = get_error().code;
  unsigned next = newest;
  for (int i = 0; i < kMostErrors && next != hd::kSuccess; ++i) next = get_error().code;
  return newest;
}

OpenHapticsFacts OpenHapticsLibrary::read_facts() const {
  OpenHapticsFacts facts;
  facts.model = text_or_empty(get_name(hd::kModel));
  facts.serial_number = text_or_empty(get_name(hd::kSerialNumber));
  get_numbers(hd::kContinuousForce, &facts.continuous_force);
  get_numbers(hd::kMaximumStiffness, &facts.maximum_stiffness);
  get_numbers(hd::kContinuousTorque, &facts.continuous_torque);
  get_integers(hd::kCalibrationStyle, &facts.calibration_styles);
  facts.continuous_force = positive_or_zero(facts.continuous_force);
  facts.continuous_torque = positive_or_zero(kTorqueUnit * facts.continuous_torque);
  facts.maximum_stiffness = positive_or_zero(facts.maximum_stiffness / kLengthUnit);
  return facts;
}

std::string OpenHapticsLibrary::describe(unsigned code) const {
  const char* name = error_name(code);
  return fmt::format("{}, 0x{:04x}", name == nullptr || *name == '\0' ? "no reason given" : name,
                     code);
}

bool OpenHapticsErrors::open(OpenHapticsLibrary::Device device) noexcept {
  Entry* entry = find(device);
  if (entry == nullptr) entry = find_free();
  if (entry == nullptr) return false;
  entry->device = device;
  entry->code = hd::kSuccess;
  entry->is_open = true;
  return true;
}

void OpenHapticsErrors::close(OpenHapticsLibrary::Device device) noexcept {
  if (Entry* entry = find(device)) entry->is_open = false;
}

unsigned OpenHapticsErrors::take(const OpenHapticsLibrary& library,
                                 OpenHapticsLibrary::Device caller) noexcept {
  for (int i = 0; i < OpenHapticsLibrary::kMostErrors; ++i) {
    const OpenHapticsLibrary::Failure failure = library.get_error();
    if (failure.code == hd::kSuccess) break;
    keep(failure, caller);
  }
  Entry* own = find(caller);
  return own == nullptr ? hd::kSuccess : own->code.exchange(hd::kSuccess);
}

void OpenHapticsErrors::keep(const OpenHapticsLibrary::Failure& failure,
                             OpenHapticsLibrary::Device caller) noexcept {
  Entry* entry = find(failure.device);
  if (entry == nullptr) entry = find(caller);
  if (entry == nullptr || !entry->is_open) return;
  unsigned none = hd::kSuccess;
  entry->code.compare_exchange_strong(none, failure.code);
}

OpenHapticsErrors::Entry* OpenHapticsErrors::find(OpenHapticsLibrary::Device device) noexcept {
  if (device == hd::kNoDevice) return nullptr;
  auto* const found = std::ranges::find_if(
      entries_, [device](const Entry& entry) { return entry.device == device; });
  return found == entries_.end() ? nullptr : found;
}

// Prefers an entry never used to one of a closed device, whose late errors have to be dropped.
OpenHapticsErrors::Entry* OpenHapticsErrors::find_free() noexcept {
  for (Entry& entry : entries_) {
    if (entry.device == hd::kNoDevice) return &entry;
  }
  for (Entry& entry : entries_) {
    if (!entry.is_open) return &entry;
  }
  return nullptr;
}

}  // namespace palpate::device
