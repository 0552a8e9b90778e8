#pragma once

#include <string_view>
#include <vector>

#include "apps/palpate/doctor/usb.hpp"

namespace palpate::app::doctor {

enum class DeviceKind {
  haptic,
  camera,
  part,  ///< of a camera: a motor, microphones
};

/// What a device is and how programs reach it.
struct KnownDevice {
  std::string_view name;
  DeviceKind kind;
  /// A driver of `palpate cameras` or a vendor's library; "service": Haply's; empty: none.
  std::string_view reached_by;
  std::string_view rival;  ///< a driver of the kernel that takes it away; empty: none
};

/// A device that is plugged in and known.
struct Found {
  UsbDevice device;
  KnownDevice known;
};

/// Those among `devices` that palpate knows.
[[nodiscard]] std::vector<Found> known_among(const std::vector<UsbDevice>& devices);

/// Is one there that is reached so?
[[nodiscard]] bool reaches_any(std::string_view way, const std::vector<Found>& found);

}  // namespace palpate::app::doctor
