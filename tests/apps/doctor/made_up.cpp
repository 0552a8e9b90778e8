#include "apps/doctor/made_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace palpate::app::doctor {

namespace fs = std::filesystem;

namespace {

constexpr const char* kUsb = "sys/bus/usb/devices/";

RealtimeReport refused() {
  const std::string remedy = "Operation not permitted; permit it";
  return {{{"real-time priority 80 (SCHED_FIFO)", false, remedy},
           {"memory locked (mlockall)", false, remedy}}};
}

RealtimeReport granted() {
  return {
      {{"real-time priority 80 (SCHED_FIFO)", true, ""}, {"memory locked (mlockall)", true, ""}}};
}

DriverInfo absent_driver(const std::string& name) {
  return {.name = name,
          .description = "",
          .available = false,
          .missing = "this build has no " + name,
          .devices = {}};
}

}  // namespace

MadeUp::MadeUp() {
  system.root = root_.path();
  system.share = root_.path() / "usr/local/share/palpate";
  system.try_realtime = [](double) { return RealtimeTrial{refused(), {}, 0}; };
  system.cameras = [] { return std::vector{absent_driver("openni2"), absent_driver("freenect")}; };
  system.node = [](const fs::path& path) {
    return Node{fs::exists(path), fs::exists(path), true, "plugdev"};
  };
  system.try_library = [](const std::string&) { return LibraryTrial{}; };
  system.listens = [](int) { return false; };
  system.decimal_point = [](const std::string& name) {
    return name == "C" || name == "C.UTF-8" ? std::optional<std::string>(".") : std::nullopt;
  };
  system.succeeds = [](const std::vector<std::string>&) { return false; };
}

void MadeUp::usb(const std::string& place, const std::string& vendor, const std::string& product,
                 int bus, int number, const std::string& driver, const std::string& title) {
  const std::string folder = kUsb + place + "/";
  file(folder + "idVendor", vendor);
  file(folder + "idProduct", product);
  file(folder + "product", title);
  file(folder + "busnum", std::to_string(bus));
  file(folder + "devnum", std::to_string(number));
  const std::string interface = folder + place + ":1.0/";
  file(interface + "bInterfaceNumber", "00");
  if (!driver.empty()) {
    fs::create_symlink("../../../bus/usb/drivers/" + driver, root_ / (interface + "driver"));
  }
  file(fmt::format("dev/bus/usb/{:03}/{:03}", bus, number), "");
}

void MadeUp::terminal(const std::string& place, const std::string& name) {
  file(kUsb + place + "/" + place + ":1.0/tty/" + name + "/dev", "166:0");
  file("dev/" + name, "");
}

void MadeUp::make_healthy() {
  file("proc/version", "Linux version 6.1.0-rt (d@e) #1 SMP PREEMPT_RT Debian");
  file("proc/self/limits", "Max locked memory   unlimited  unlimited  bytes");
  file("proc/sys/kernel/sched_rt_runtime_us", "950000");
  file("proc/sys/net/core/rmem_max", "2147483647");
  file("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  file("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
  file("usr/local/share/palpate/60-palpate.rules", "");
  file("usr/local/share/palpate/palpate-limits.conf", "");
  file("usr/bin/xdg-open", "");
  file("usr/bin/firefox", "");
  file("run/user/1000/bus", "");
  system.variables = {
      {"DISPLAY", ":0"}, {"LANG", "C.UTF-8"}, {"XDG_RUNTIME_DIR", "/run/user/1000"}};
  system.try_realtime = [](double) { return RealtimeTrial{granted(), {}, 0}; };
  system.succeeds = [](const std::vector<std::string>&) { return true; };
}

Finding about(const std::string& looked_at, const Findings& findings) {
  const auto found = std::ranges::find(findings, looked_at, &Finding::looked_at);
  if (found == findings.end()) throw std::logic_error("no finding on " + looked_at);
  return *found;
}

}  // namespace palpate::app::doctor
