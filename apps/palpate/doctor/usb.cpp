#include "apps/palpate/doctor/usb.hpp"

#include <fmt/format.h>

#include <charconv>

namespace palpate::app::doctor {

namespace fs = std::filesystem;

namespace {

constexpr const char* kDevices = "sys/bus/usb/devices/";

int number(const std::string& words) {
  int result = 0;
  std::from_chars(words.data(), words.data() + words.size(), result);
  return result;
}

// ttyACM0 lies in a folder tty, ttyUSB0 in the interface itself.
void add_terminals(const fs::path& folder, std::vector<std::string>& terminals) {
  for (const fs::path& entry : entries(folder)) {
    const std::string name = entry.filename().string();
    if (name == "tty") add_terminals(entry, terminals);
    if (name.starts_with("ttyACM") || name.starts_with("ttyUSB")) terminals.push_back(name);
  }
}

// What holds its interfaces: folders "1-4:1.0" in the device's.
void add_interfaces(const fs::path& folder, UsbDevice& device) {
  for (const fs::path& entry : entries(folder)) {
    if (!entry.filename().string().starts_with(device.place + ":")) continue;
    std::error_code none;
    const fs::path driver = fs::read_symlink(entry / "driver", none);
    if (!none) device.drivers.push_back(driver.filename().string());
    add_terminals(entry, device.terminals);
  }
}

}  // namespace

std::vector<UsbDevice> usb_devices(const System& system) {
  std::vector<UsbDevice> devices;
  for (const fs::path& folder : entries(system.root / kDevices)) {
    const std::string place = folder.filename().string();
    const auto told = [&](const char* name) {
      return text(system, kDevices + place + "/" + name).value_or("");
    };
    UsbDevice device{.place = place, .vendor = told("idVendor"), .product = told("idProduct")};
    if (device.vendor.empty()) continue;  // an interface
    device.title = told("manufacturer") + " " + told("product");
    device.bus = number(told("busnum"));
    device.number = number(told("devnum"));
    add_interfaces(folder, device);
    devices.push_back(device);
  }
  return devices;
}

std::string node_of(const UsbDevice& device) {
  return fmt::format("dev/bus/usb/{:03}/{:03}", device.bus, device.number);
}

}  // namespace palpate::app::doctor
