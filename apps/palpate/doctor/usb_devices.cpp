// Finds known haptic devices and cameras on USB.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/palpate/doctor/checks.hpp"

namespace palpate::app::doctor {

namespace fs = std::filesystem;

namespace {

constexpr const char* kDevices = "sys/bus/usb/devices/";

// How models are distinguished: by vendor and product, any product where that is empty, and, where
// a vendor makes other things too, by a word of what the device calls itself.
struct Sign {
  std::string_view vendor;
  std::string_view product;
  std::string_view word;
  DeviceModel model;
};

constexpr auto kHaptic = DeviceKind::haptic;
constexpr auto kCamera = DeviceKind::camera;
constexpr auto kPart = DeviceKind::part;

constexpr std::array kSigns = {
    Sign{"1451", "", "", {"Force Dimension", kHaptic, "libdhd.so.3", ""}},
    Sign{"0403", "cb48", "", {"Novint Falcon", kHaptic, "libdhd.so.3", "ftdi_sio"}},
    Sign{"2988", "", "", {"3D Systems Touch", kHaptic, "libHD.so", ""}},
    Sign{"0301", "2988", "", {"3D Systems Touch Stylus", kHaptic, "libHD.so", ""}},
    Sign{"", "", "Haply", {"Haply", kHaptic, "service", ""}},
    Sign{"1d27", "", "", {"PrimeSense or Xtion", kCamera, "openni2", ""}},
    Sign{"045e", "02ae", "", {"Kinect v1", kCamera, "freenect", "gspca_kinect"}},
    Sign{"045e", "02bf", "", {"Kinect v1 for Windows", kCamera, "freenect", "gspca_kinect"}},
    Sign{"045e", "02b0", "", {"Kinect's motor", kPart, "", ""}},
    Sign{"045e", "02ad", "", {"Kinect's microphones", kPart, "", ""}},
    Sign{"8086", "", "RealSense", {"RealSense", kCamera, "", ""}},
};

bool fits(const Sign& sign, const UsbDevice& device) {
  const auto is = [](std::string_view wanted, const std::string& found) {
    return wanted.empty() || wanted == found;
  };
  return is(sign.vendor, device.vendor) && is(sign.product, device.product) &&
         device.title.find(sign.word) != std::string::npos;
}

// ttyACM0 lies in a folder tty, ttyUSB0 in the interface itself.
void add_terminals(const fs::path& folder, std::vector<std::string>& terminals) {
  for (const fs::path& entry : entries(folder)) {
    const std::string name = entry.filename().string();
    if (name == "tty") add_terminals(entry, terminals);
    if (name.starts_with("ttyACM") || name.starts_with("ttyUSB")) terminals.push_back(name);
  }
}

// Kernel drivers of its interfaces: folders "1-4:1.0" in the device's.
void add_interfaces(const fs::path& folder, UsbDevice& device) {
  for (const fs::path& entry : entries(folder)) {
    if (!entry.filename().string().starts_with(device.path + ":")) continue;
    std::error_code none;
    const fs::path driver = fs::read_symlink(entry / "driver", none);
    if (!none) device.drivers.push_back(driver.filename().string());
    add_terminals(entry, device.terminals);
  }
}

UsbDevice read_device(const System& system, const fs::path& folder) {
  const std::string bus_path = folder.filename().string();
  const auto attribute = [&](const char* name) {
    return text(system, kDevices + bus_path + "/" + name).value_or("");
  };
  UsbDevice device{
      .path = bus_path, .vendor = attribute("idVendor"), .product = attribute("idProduct")};
  device.title = attribute("manufacturer") + " " + attribute("product");
  device.bus = whole_number(system, kDevices + bus_path + "/busnum").value_or(0);
  device.number = whole_number(system, kDevices + bus_path + "/devnum").value_or(0);
  add_interfaces(folder, device);
  return device;
}

std::string title(const KnownUsbDevice& found) {
  return fmt::format("{} ({}:{} at {})", found.model.name, found.device.vendor,
                     found.device.product, found.device.path);
}

// A serial device is used through its terminals, any other through its node.
std::vector<std::string> nodes_of(const UsbDevice& device) {
  std::vector<std::string> nodes;
  for (const std::string& terminal : device.terminals) nodes.push_back("dev/" + terminal);
  if (nodes.empty()) {
    nodes.push_back(fmt::format("dev/bus/usb/{:03}/{:03}", device.bus, device.number));
  }
  return nodes;
}

Answer closed(const System& system, const KnownUsbDevice& found, const std::string& path,
              const Node& node) {
  const std::string words = fmt::format("{}: no permission to open /{}", title(found), path);
  const bool by_group = node.group_may && node.group != "root" && !node.group.empty() &&
                        !system.groups.contains(node.group);
  if (!by_group) {
    return problem(words + "; the udev rules allow only root", usb_command(system));
  }
  return problem(words + fmt::format("; join the group {} and log in again", node.group),
                 fmt::format("sudo usermod -aG {} \"$USER\"", node.group));
}

Answer access(const System& system, const KnownUsbDevice& found) {
  for (const std::string& path : nodes_of(found.device)) {
    const Node node = system.node(system.root / path);
    if (!node.there) {
      return problem(fmt::format("{} is plugged in, but /{} does not exist", title(found), path),
                     in_container(system) ? usb_command(system) : "sudo udevadm trigger");
    }
    if (!node.may_open) return closed(system, found, path, node);
  }
  return good(title(found) + ": accessible");
}

Answer held_by(const KnownUsbDevice& found, const std::string& rival) {
  return warning(fmt::format("{} is claimed by the kernel driver {}, which may not release it",
                             title(found), rival),
                 fmt::format("echo 'blacklist {0}' | sudo tee /etc/modprobe.d/palpate-{0}.conf && "
                             "sudo modprobe -r {0}",
                             rival));
}

Answer absence(const System& system, DeviceKind kind) {
  if (!is_there(system, "sys/bus/usb")) {
    return note("unknown: /sys does not list USB devices",
                is_there(system, "sys/bus") ? usb_command(system) : kMountSys);
  }
  return kind == kHaptic
             ? note("no known device; without one, use a mouse on the page", "palpate demo")
             : note("no known camera; without one, touch a simulated one",
                    "palpate touch camera:simulated:table --view");
}

}  // namespace

std::vector<KnownUsbDevice> known_usb_devices(const System& system) {
  std::vector<KnownUsbDevice> devices;
  for (const fs::path& folder : entries(system.root / kDevices)) {
    UsbDevice device = read_device(system, folder);
    if (device.vendor.empty()) continue;  // an interface
    const auto fits_device = [&](const Sign& sign) { return fits(sign, device); };
    const auto* const sign = std::ranges::find_if(kSigns, fits_device);
    if (sign != kSigns.end()) devices.push_back({std::move(device), sign->model});
  }
  return devices;
}

bool any_reached_by(std::string_view driver, const std::vector<KnownUsbDevice>& devices) {
  return std::ranges::any_of(
      devices, [driver](const KnownUsbDevice& each) { return each.model.reached_by == driver; });
}

bool has_rules(const System& system) {
  return is_there(system, "etc/udev/rules.d/60-palpate.rules") ||
         is_there(system, "usr/lib/udev/rules.d/60-palpate.rules");
}

std::string usb_command(const System& system) {
  if (in_container(system)) {
    return "docker run -it -v /dev:/dev --device-cgroup-rule 'c 189:* rmw' "
           "--device-cgroup-rule 'c 166:* rmw' IMAGE";
  }
  if (!is_there(system, "sys/bus/usb")) return "sudo modprobe xhci_pci";
  const std::string copy = has_rules(system)
                               ? ""
                               : fmt::format("sudo cp {}/60-palpate.rules /etc/udev/rules.d/ && ",
                                             system.share.string());
  return copy + "sudo udevadm control --reload && sudo udevadm trigger";
}

void check_usb(const Machine& machine, DeviceKind kind, const char* area, Findings& findings) {
  bool any = false;
  for (const KnownUsbDevice& each : machine.devices) {
    if (each.model.kind != kind) continue;
    any = true;
    findings.push_back({access(machine.system, each), area, std::string(each.model.name)});
    const std::string rival(each.model.rival);
    if (rival.empty() || std::ranges::count(each.device.drivers, rival) == 0) continue;
    findings.push_back({held_by(each, rival), area, "kernel drivers"});
  }
  if (!any) findings.push_back({absence(machine.system, kind), area, "on USB"});
}

}  // namespace palpate::app::doctor
