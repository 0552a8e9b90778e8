#pragma once

#include <string>

#include "device/vendor_library.hpp"

namespace palpate::device {

/// The part of Force Dimension's C interface (its SDK 3) that is used here. All numbers in metres,
/// newtons, seconds; below 0 is an error, above it a note.
struct ForceDimensionLibrary {
  static constexpr const char* kName = "libdhd.so.3";

  /// @throws Error that says what is missing.
  explicit ForceDimensionLibrary(const std::string& file = kName);

  /// What it says of its last error in this thread.
  [[nodiscard]] std::string last_words() const;

  VendorLibrary library;
  int (*count)() = nullptr;  // of devices, those in use too
  int (*open)(char index) = nullptr;
  int (*close)(char id) = nullptr;
  const char* (*title)(char id) = nullptr;
  int (*status)(int* flags, char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*enable_expert_mode)() = nullptr;
  int (*disable_expert_mode)() = nullptr;
  int (*set_watchdog)(unsigned char duration, char id) = nullptr;  // in 125 us
  int (*position)(double* x, double* y, double* z, char id) = nullptr;
  int (*velocity)(double* x, double* y, double* z, char id) = nullptr;
  unsigned (*buttons)(char id) = nullptr;
  bool (*has_wrist)(char id) = nullptr;
  bool (*has_gripper)(char id) = nullptr;
  int (*orientation)(double rows[3][3], char id) = nullptr;  // from the tool's axes to the base's
  int (*gripper)(double* gap, char id) = nullptr;
  int (*set_force)(double x, double y, double z, double around_x, double around_y, double around_z,
                   double gripper, char id) = nullptr;

 private:
  const char* (*last_error_)() = nullptr;
};

}  // namespace palpate::device
