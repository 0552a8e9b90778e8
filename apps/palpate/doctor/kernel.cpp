#include "apps/palpate/doctor/kernel.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace palpate::app::doctor {

namespace {

constexpr const char* kArea = "kernel";
constexpr const char* kMountProc = "sudo mount -t proc proc /proc";
constexpr const char* kClock = "sys/devices/system/clocksource/clocksource0/";

// Of "Linux version 6.1.0-18-amd64 (debian-kernel@...": the third word.
std::string release_of(const std::string& version) {
  const std::size_t begin = version.find("version ");
  if (begin == std::string::npos) return "unknown";
  const std::size_t from = begin + 8;
  return version.substr(from, version.find(' ', from) - from);
}

// Each kind once, such as "powersave".
std::set<std::string> governors(const System& system) {
  std::set<std::string> found;
  for (const auto& folder : entries(system.root / "sys/devices/system/cpu")) {
    const auto path = "sys/devices/system/cpu/" + folder.filename().string();
    const auto governor = text(system, path + "/cpufreq/scaling_governor");
    if (governor) found.insert(*governor);
  }
  return found;
}

bool is_slow(const std::string& clock) {
  static constexpr std::array<std::string_view, 4> kSlow = {"hpet", "acpi_pm", "jiffies",
                                                            "refined-jiffies"};
  return std::ranges::find(kSlow, clock) != kSlow.end();
}

}  // namespace

std::string realtime_kernel_command(const System& system) {
  return is_ubuntu(system) ? "sudo pro attach && sudo pro enable realtime-kernel"
                           : "sudo apt install linux-image-rt-amd64 && sudo reboot";
}

Finding check_preemption(const System& system) {
  Finding finding{kArea, "preemption"};
  const auto version = text(system, "proc/version");
  if (!version) {
    finding.severity = Severity::note;
    finding.words = "/proc/version cannot be read, so the kernel is not known";
    finding.remedy = kMountProc;
    return finding;
  }
  const bool realtime = text(system, "sys/kernel/realtime") == "1" ||
                        version->find("PREEMPT_RT") != std::string::npos;
  if (realtime) {
    finding.words = fmt::format("real-time (PREEMPT_RT), {}", release_of(*version));
    return finding;
  }
  finding.severity = Severity::note;
  finding.words = fmt::format(
      "{} is no real-time kernel (PREEMPT_RT): under load, drivers may delay a step by "
      "milliseconds",
      release_of(*version));
  if (in_container(system)) finding.words += "; a container has the kernel of its host";
  finding.remedy = realtime_kernel_command(system);
  return finding;
}

Finding check_governor(const System& system) {
  Finding finding{kArea, "frequency governor"};
  const std::set<std::string> found = governors(system);
  if (found.empty()) {
    finding.words = "the kernel leaves the processors' frequency alone";
    return finding;
  }
  if (found == std::set<std::string>{"performance"}) {
    finding.words = "performance";
    return finding;
  }
  const bool slow = found.contains("powersave");
  finding.severity = slow ? Severity::warning : Severity::note;
  finding.words =
      fmt::format("{}: processors slow down between steps, and are slow when one begins",
                  fmt::join(found, ", "));
  finding.remedy =
      "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor";
  return finding;
}

Finding check_clock_source(const System& system) {
  Finding finding{kArea, "clock source"};
  const auto current = text(system, std::string(kClock) + "current_clocksource");
  if (!current) {
    finding.severity = Severity::note;
    finding.words = "/sys does not tell it";
    finding.remedy = kMountSys;
    return finding;
  }
  finding.words = *current;
  if (!is_slow(*current)) return finding;
  finding.severity = Severity::warning;
  const auto available = text(system, std::string(kClock) + "available_clocksource").value_or("");
  if (available.find("tsc") != std::string::npos) {
    finding.words += ": each look at the clock takes a microsecond or more, with tsc some 20 ns";
    finding.remedy = fmt::format("echo tsc | sudo tee /{}current_clocksource", kClock);
  } else {
    finding.words += ": each look at the clock takes a microsecond or more; the kernel refused tsc";
    finding.remedy = "sudo dmesg | grep -iE 'tsc|clocksource'";
  }
  return finding;
}

}  // namespace palpate::app::doctor
