#include "apps/palpate/doctor/devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace palpate::app::doctor {

namespace {

std::string area_of(DeviceKind kind) {
  return kind == DeviceKind::haptic ? "haptic devices" : "cameras";
}

std::string title(const Found& found) {
  return fmt::format("{} ({}:{} at {})", found.known.name, found.device.vendor,
                     found.device.product, found.device.place);
}

// A serial device is used through its terminals, any other through its node.
std::vector<std::string> nodes_of(const UsbDevice& device) {
  std::vector<std::string> nodes;
  for (const std::string& terminal : device.terminals) nodes.push_back("dev/" + terminal);
  if (nodes.empty()) nodes.push_back(node_of(device));
  return nodes;
}

Finding absent(const System& system, const Found& found, const std::string& node) {
  Finding finding{area_of(found.known.kind), std::string(found.known.name), Severity::problem};
  finding.words = fmt::format("{} is plugged in, but /{} is not there", title(found), node);
  finding.remedy = in_container(system) ? usb_command(system) : "sudo udevadm trigger";
  return finding;
}

Finding closed(const System& system, const Found& found, const std::string& path,
               const Node& node) {
  Finding finding{area_of(found.known.kind), std::string(found.known.name), Severity::problem};
  finding.words = fmt::format("{}: this user may not open /{}", title(found), path);
  const bool by_group = node.group_may && node.group != "root" && !node.group.empty() &&
                        !system.groups.contains(node.group);
  if (by_group) {
    finding.words += fmt::format("; group {} may (with a new login)", node.group);
    finding.remedy = fmt::format("sudo usermod -aG {} \"$USER\"", node.group);
  } else {
    finding.words += "; udev's rules permit it to nobody but root";
    finding.remedy = usb_command(system);
  }
  return finding;
}

Finding check_access(const System& system, const Found& found) {
  for (const std::string& path : nodes_of(found.device)) {
    const Node node = system.node(system.root / path);
    if (!node.there) return absent(system, found, path);
    if (!node.may_open) return closed(system, found, path, node);
  }
  return {area_of(found.known.kind), std::string(found.known.name), Severity::good,
          title(found) + ": this user may open it"};
}

void add_rival(const Found& found, Findings& findings) {
  const std::string rival(found.known.rival);
  if (rival.empty() || std::ranges::count(found.device.drivers, rival) == 0) return;
  Finding finding{area_of(found.known.kind), "kernel drivers", Severity::warning};
  finding.words = fmt::format("{} is held by the kernel's driver {}, which may refuse to let it go",
                              title(found), rival);
  finding.remedy = fmt::format(
      "echo 'blacklist {0}' | sudo tee /etc/modprobe.d/palpate-{0}.conf && sudo modprobe -r {0}",
      rival);
  findings.push_back(finding);
}

void add_shared_buses(const std::vector<Found>& found, Findings& findings) {
  std::map<int, int> cameras;
  for (const Found& each : found) {
    if (each.known.kind == DeviceKind::camera) ++cameras[each.device.bus];
  }
  for (const auto& [bus, count] : cameras) {
    if (count < 2) continue;
    findings.push_back(
        {"cameras", "USB bandwidth", Severity::warning,
         fmt::format("{} cameras share bus {}: frames may be lost; plug them into ports of "
                     "different controllers",
                     count, bus),
         "lsusb -t"});
  }
}

// A Kinect without its own power supply shows its motor or microphones, and no camera.
void add_powerless(const std::vector<Found>& found, Findings& findings) {
  const auto parts = std::ranges::count(found, DeviceKind::part,
                                        [](const Found& each) { return each.known.kind; });
  if (parts == 0 || reaches_any("freenect", found)) return;
  findings.push_back({"cameras", "Kinect v1", Severity::problem,
                      "parts of a Kinect are there, its camera is not: plug in its own power "
                      "supply, then look again",
                      "lsusb -d 045e:"});
}

void add_absence(const System& system, const std::vector<Found>& found, DeviceKind kind,
                 Findings& findings) {
  const auto of_kind = [kind](const Found& each) { return each.known.kind == kind; };
  if (std::ranges::any_of(found, of_kind)) return;
  if (!is_there(system, "sys/bus/usb")) {
    findings.push_back({area_of(kind), "on USB", Severity::note,
                        "/sys does not tell what is plugged in",
                        is_there(system, "sys/bus") ? usb_command(system) : kMountSys});
    return;
  }
  const bool haptic = kind == DeviceKind::haptic;
  findings.push_back({area_of(kind), "on USB", Severity::note,
                      haptic ? "none that is known; without one, a mouse on the page is a hand"
                             : "none that is known; without one, touch a simulated one",
                      haptic ? "palpate demo" : "palpate touch camera:simulated:table --view"});
}

}  // namespace

std::string usb_command(const System& system) {
  if (in_container(system)) {
    return "docker run -it -v /dev:/dev --device-cgroup-rule 'c 189:* rmw' "
           "--device-cgroup-rule 'c 166:* rmw' IMAGE";
  }
  if (!is_there(system, "sys/bus/usb")) return "sudo modprobe xhci_pci";
  return fmt::format(
      "sudo cp {}/60-palpate.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
      "sudo udevadm trigger",
      system.share.string());
}

Findings check_devices(const System& system, const std::vector<Found>& found) {
  Findings findings;
  for (const DeviceKind kind : {DeviceKind::haptic, DeviceKind::camera}) {
    add_absence(system, found, kind, findings);
    for (const Found& each : found) {
      if (each.known.kind != kind) continue;
      findings.push_back(check_access(system, each));
      add_rival(each, findings);
    }
  }
  add_powerless(found, findings);
  add_shared_buses(found, findings);
  return findings;
}

}  // namespace palpate::app::doctor
