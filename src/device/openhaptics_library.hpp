#pragma once

#include <string>
#include <vector>

#include "device/vendor_library.hpp"

namespace palpate::device {

/// The part of OpenHaptics' C interface to devices (HDAPI 3) that is used here; its numbers are in
/// openhaptics_codes.hpp. Most functions speak of the current device, which a frame makes so.
struct OpenHapticsLibrary {
  using Device = unsigned;
  using Callback = unsigned(void* data);
  using Name = const char*;

  static constexpr int kMostErrors = 16;  ///< that it may keep

  /// An error, as the library returns it by value.
  struct Failure {
    unsigned code = 0;
    int detail = 0;
    Device device = 0;  // whose
  };

  /// The names that it may have, the most exact first.
  static const std::vector<std::string>& names();

  /// `file`: a path, or empty for the first of names() that loads.
  /// @throws Error that says what is missing.
  explicit OpenHapticsLibrary(const std::string& file = "");

  /// The code of the newest error, whoever's it is, or hd::kSuccess; forgets all that it keeps.
  /// Bounded work.
  [[nodiscard]] unsigned take_errors() const noexcept;

  /// What it calls an error, and the code.
  [[nodiscard]] std::string words(unsigned code) const;

  VendorLibrary library;
  Device (*init_device)(Name configuration) = nullptr;
  void (*disable_device)(Device device) = nullptr;
  void (*make_current)(Device device) = nullptr;
  void (*enable)(unsigned capability) = nullptr;
  void (*disable)(unsigned capability) = nullptr;
  Failure (*get_error)() = nullptr;  // the newest, which is forgotten then
  Name (*error_name)(unsigned code) = nullptr;

  void (*begin_frame)(Device device) = nullptr;
  void (*end_frame)(Device device) = nullptr;
  void (*get_numbers)(unsigned what, double* numbers) = nullptr;
  void (*get_integers)(unsigned what, int* numbers) = nullptr;
  Name (*get_name)(unsigned what) = nullptr;
  void (*set_numbers)(unsigned what, const double* numbers) = nullptr;
  unsigned (*check_calibration)() = nullptr;
  void (*update_calibration)(unsigned style) = nullptr;

  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  unsigned long (*schedule)(Callback* callback, void* data, unsigned short priority) = nullptr;
};

}  // namespace palpate::device
