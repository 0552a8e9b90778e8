#pragma once

#include <string>
#include <vector>

#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// A device on USB, as the kernel tells in /sys/bus/usb/devices.
struct UsbDevice {
  std::string place;       ///< "1-4.2"
  std::string vendor;      ///< "045e"
  std::string product;     ///< "02ae"
  std::string title = {};  ///< what the device calls its maker and itself: may be anything
  int bus = 0;
  int number = 0;                           ///< on the bus
  std::vector<std::string> drivers = {};    ///< the kernel's, of its interfaces
  std::vector<std::string> terminals = {};  ///< "ttyACM0"
};

/// All that are plugged in, in the order of their places.
[[nodiscard]] std::vector<UsbDevice> usb_devices(const System& system);

/// "dev/bus/usb/001/004".
[[nodiscard]] std::string node_of(const UsbDevice& device);

}  // namespace palpate::app::doctor
