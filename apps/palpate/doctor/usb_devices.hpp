#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// A device on USB, as the kernel tells in /sys/bus/usb/devices.
struct UsbDevice {
  std::string place;       ///< "1-4.2"
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

/// What a device is and how programs reach it.
struct DeviceModel {
  std::string_view name;
  DeviceKind kind;
  /// A driver of `palpate cameras` or a vendor's library; "service": Haply's; empty: none.
  std::string_view reached_by;
  std::string_view rival;  ///< a driver of the kernel that takes it away; empty: none
};

/// A device that is plugged in and whose model palpate knows.
struct KnownUsbDevice {
  UsbDevice device;
  DeviceModel model;
};

/// Those that palpate knows, in the order of their places.
[[nodiscard]] std::vector<KnownUsbDevice> known_usb_devices(const System& system);

/// Is one there that is reached by this driver or library?
[[nodiscard]] bool any_reached_by(std::string_view driver,
                                  const std::vector<KnownUsbDevice>& devices);

}  // namespace palpate::app::doctor
