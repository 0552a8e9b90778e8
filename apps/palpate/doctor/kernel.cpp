// Checks the kernel, real-time rights and the jitter of a servo.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/doctor/checks.hpp"

namespace palpate::app::doctor {

namespace {

constexpr const char* kKernel = "kernel";
constexpr const char* kRights = "real-time rights";
constexpr const char* kClock = "sys/devices/system/clocksource/clocksource0/";
constexpr double kSchedulingPeriod = 1e6;  // us, the kernel's sched_rt_period_us
constexpr double kEnough = 0.5;            // of it, for real-time threads
constexpr double kStep = 1e-3;             // s, of the loop whose jitter is measured
constexpr double kFirstBin = 1.25e-7;      // s, the lower end of a Durations' first bin
constexpr double kWidest = 40;             // characters of the longest bar

std::string realtime_kernel_command(const System& system) {
  return is_ubuntu(system) ? "sudo pro attach && sudo pro enable realtime-kernel"
                           : "sudo apt install linux-image-rt-amd64 && sudo reboot";
}

// Lets this user run real-time threads and lock memory.
std::string rights_command(const System& system) {
  if (in_container(system)) {
    return "docker run -it --cap-add SYS_NICE --ulimit rtprio=95 --ulimit memlock=-1 IMAGE";
  }
  if (is_there(system, kLimits)) {
    return "sudo usermod -aG realtime \"$USER\" && exec su - \"$USER\"";
  }
  return fmt::format(
      "sudo groupadd -f realtime && sudo usermod -aG realtime \"$USER\" && "
      "sudo cp {}/palpate-limits.conf /etc/security/limits.d/",
      system.share.string());
}

// The third word of "Linux version 6.1.0-18-amd64 (debian-kernel@...".
std::string release_of(const std::string& version) {
  const std::size_t begin = version.find("version ");
  if (begin == std::string::npos) return "unknown";
  const std::size_t from = begin + 8;
  return version.substr(from, version.find(' ', from) - from);
}

Answer preemption(const Machine& machine) {
  const System& system = machine.system;
  const auto version = text(system, "proc/version");
  if (!version) {
    return note("kernel unknown: /proc/version cannot be read", "sudo mount -t proc proc /proc");
  }
  if (text(system, "sys/kernel/realtime") == "1" ||
      version->find("PREEMPT_RT") != std::string::npos) {
    return good(fmt::format("real-time (PREEMPT_RT), {}", release_of(*version)));
  }
  return note(fmt::format("{} is not a real-time kernel (PREEMPT_RT): under load, drivers may "
                          "delay a step by milliseconds{}",
                          release_of(*version),
                          in_container(system) ? "; a container uses its host's kernel" : ""),
              realtime_kernel_command(system));
}

Answer frequency_governor(const Machine& machine) {
  std::set<std::string> found;  // each kind once, such as "powersave"
  for (const auto& folder : entries(machine.system.root / "sys/devices/system/cpu")) {
    const auto path = "sys/devices/system/cpu/" + folder.filename().string();
    const auto governor = text(machine.system, path + "/cpufreq/scaling_governor");
    if (governor) found.insert(*governor);
  }
  if (found.empty()) return good("no frequency scaling");
  if (found == std::set<std::string>{"performance"}) return good("performance");
  return {found.contains("powersave") ? Severity::warning : Severity::note,
          fmt::format("{}: CPUs slow down between steps and start each step slowly",
                      fmt::join(found, ", ")),
          "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

Answer clock_source(const Machine& machine) {
  static constexpr std::array<std::string_view, 4> kSlow = {"hpet", "acpi_pm", "jiffies",
                                                            "refined-jiffies"};
  const auto content = [&](const char* file) {
    return text(machine.system, std::string(kClock) + file);
  };
  const auto current = content("current_clocksource");
  if (!current) return note("unknown: not in /sys", kMountSys);
  if (std::ranges::find(kSlow, *current) == kSlow.end()) return good(*current);
  const std::string words = *current + ": reading the clock takes a microsecond or more";
  if (content("available_clocksource").value_or("").find("tsc") != std::string::npos) {
    return warning(words + ", about 20 ns with tsc",
                   fmt::format("echo tsc | sudo tee /{}current_clocksource", kClock));
  }
  return warning(words + "; the kernel rejected tsc", "sudo dmesg | grep -iE 'tsc|clocksource'");
}

// A histogram with one row an octave, from the first that holds a step to the last.
std::vector<std::string> histogram(const Durations& lateness) {
  std::vector<std::uint64_t> rows;
  for (std::size_t bin = 0; bin < Durations::kBins; bin += Durations::kPerOctave) {
    const auto octave = std::span(lateness.counts).subspan(bin, Durations::kPerOctave);
    rows.push_back(std::accumulate(octave.begin(), octave.end(), std::uint64_t{0}));
  }
  const auto holds = [](std::uint64_t steps) { return steps > 0; };
  const auto first = std::ranges::find_if(rows, holds);
  const auto last = std::find_if(rows.rbegin(), rows.rend(), holds).base();
  const auto most = static_cast<double>(*std::ranges::max_element(rows));
  std::vector<std::string> lines;
  for (auto row = first; row < last; ++row) {
    const double upper = kFirstBin * std::exp2(1 + std::distance(rows.begin(), row));
    const double bar = std::ceil(kWidest * static_cast<double>(*row) / most);
    lines.push_back(fmt::format("{:>12} {:>8}{}{}", "< " + duration(upper), grouped(*row),
                                *row > 0 ? " " : "",
                                std::string(static_cast<std::size_t>(bar), '#')));
  }
  return lines;
}

std::string jitter_remedy(const Machine& machine) {
  if (!machine.trial.report.all_granted()) return rights_command(machine.system);
  return preemption(machine).severity == Severity::good ? "top -b -n 1 | head -n 15"
                                                        : realtime_kernel_command(machine.system);
}

Answer jitter(const Machine& machine) {
  const Durations& lateness = machine.trial.lateness;
  Answer answer = good(fmt::format("{} steps were late by {} (median), {} (99.9 %), {} (longest)",
                                   grouped(lateness.count), duration(lateness.quantile(0.5)),
                                   duration(lateness.quantile(0.999)), duration(lateness.longest)));
  answer.lines = histogram(lateness);
  if (machine.trial.left_out == 0 && lateness.longest < kStep) return answer;
  answer.severity = lateness.quantile(0.999) < kStep ? Severity::note : Severity::warning;
  answer.words += fmt::format("; skipped: {}", grouped(machine.trial.left_out));
  if (text(machine.system, "proc/cpuinfo").value_or("").find(" hypervisor") != std::string::npos) {
    answer.words += "; this is a virtual machine, which its host may pause";
  }
  answer.remedy = jitter_remedy(machine);
  return answer;
}

Answer granted(const System& system, const RealtimeReport::Request& request) {
  if (request.granted) return good("granted");
  std::string hint = "; takes effect after a new login";
  if (in_container(system)) {
    hint = "; a container is granted it at its start";
  } else if (is_there(system, kLimits)) {
    hint = fmt::format("; /{} exists: log in again as a member of 'realtime'", kLimits);
  }
  const std::string reason = request.remedy.substr(0, request.remedy.find(';'));
  return warning(fmt::format("not granted ({}); steps will start late{}", reason, hint),
                 rights_command(system));
}

// Soft limit of a line such as "Max locked memory  67108864  67108864  bytes".
std::string limit(const std::string& limits, const std::string& name) {
  const std::size_t line = limits.find(name);
  if (line == std::string::npos) return "unknown";
  std::istringstream rest(limits.substr(line + name.size()));
  std::string soft;
  rest >> soft;
  return soft;
}

Answer limits(const Machine& machine) {
  const std::string content = text(machine.system, "proc/self/limits").value_or("");
  const std::string words =
      fmt::format("rtprio {}, memlock {}", limit(content, "Max realtime priority"),
                  limit(content, "Max locked memory"));
  if (machine.trial.report.all_granted()) return good(words);
  return note(words + "; palpate needs rtprio 80 or more and unlimited memlock",
              rights_command(machine.system));
}

Answer share_of_threads(const Machine& machine) {
  const auto microseconds = whole_number(machine.system, "proc/sys/kernel/sched_rt_runtime_us");
  if (!microseconds) return good("not limited by this kernel");
  if (*microseconds < 0) return good("not limited");
  const double share = static_cast<double>(*microseconds) / kSchedulingPeriod;
  const std::string words =
      fmt::format("{:.0f} % of the time (kernel.sched_rt_runtime_us)", 100 * share);
  if (share >= kEnough) return good(words);
  return {share > 0 ? Severity::warning : Severity::problem,
          words + ": real-time threads are paused for the rest",
          "sudo sysctl -w kernel.sched_rt_runtime_us=950000"};
}

constexpr std::array kKernelChecks = {
    Check{kKernel, "preemption", preemption},
    Check{kKernel, "frequency governor", frequency_governor},
    Check{kKernel, "clock source", clock_source},
};
constexpr std::array kRightsChecks = {
    Check{kRights, "limits", limits},
    Check{kRights, "share of real-time threads", share_of_threads},
};

}  // namespace

void check_kernel(const Machine& machine, Findings& findings) {
  run_checks(kKernelChecks, machine, findings);
  if (machine.trial.lateness.count > 0) {
    findings.push_back({jitter(machine), kKernel, "jitter at 1 kHz"});
  }
  for (const RealtimeReport::Request& request : machine.trial.report.requests) {
    findings.push_back({granted(machine.system, request), kRights, request.what});
  }
  run_checks(kRightsChecks, machine, findings);
}

}  // namespace palpate::app::doctor
