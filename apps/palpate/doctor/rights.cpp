#include "apps/palpate/doctor/rights.hpp"

#include <fmt/format.h>

#include <sstream>

namespace palpate::app::doctor {

namespace {

constexpr const char* kRights = "real-time rights";
constexpr const char* kLimits = "etc/security/limits.d/palpate-limits.conf";
constexpr double kSchedulingPeriod = 1e6;  // us, the kernel's sched_rt_period_us
constexpr double kEnough = 0.5;            // of it

std::string without_remedy(const RealtimeRequest& request) {
  return request.remedy.substr(0, request.remedy.find(';'));
}

Finding granted(const System& system, const RealtimeRequest& request) {
  Finding finding{kRights, request.what};
  finding.words = "granted";
  if (request.granted) return finding;
  finding.severity = Severity::warning;
  finding.words = fmt::format("not granted ({}); steps will start late", without_remedy(request));
  if (in_container(system)) {
    finding.words += "; a container gets it where it is started";
  } else if (is_there(system, kLimits)) {
    finding.words +=
        fmt::format("; /{} is there, so a new login of a member of 'realtime' helps", kLimits);
  } else {
    finding.words += "; takes effect with a new login";
  }
  finding.remedy = rights_command(system);
  return finding;
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

Finding check_limits(const System& system, const RealtimeReport& report) {
  const std::string limits = text(system, "proc/self/limits").value_or("");
  Finding finding{kRights, "limits"};
  finding.words = fmt::format("rtprio {}, memlock {}", limit(limits, "Max realtime priority"),
                              limit(limits, "Max locked memory"));
  if (report.all_granted()) return finding;
  finding.severity = Severity::note;
  finding.words += "; needed are rtprio 80 or more and memlock unlimited";
  finding.remedy = rights_command(system);
  return finding;
}

Finding check_share(const System& system) {
  Finding finding{kRights, "share of real-time threads"};
  const auto microseconds = whole_number(system, "proc/sys/kernel/sched_rt_runtime_us");
  if (!microseconds) {
    finding.words = "not limited by this kernel";
    return finding;
  }
  if (*microseconds < 0) {
    finding.words = "not limited";
    return finding;
  }
  const double share = static_cast<double>(*microseconds) / kSchedulingPeriod;
  finding.words = fmt::format("{:.0f} % of the time (kernel.sched_rt_runtime_us)", 100 * share);
  if (share >= kEnough) return finding;
  finding.severity = share > 0 ? Severity::warning : Severity::problem;
  finding.words += ": they are halted for the rest";
  finding.remedy = "sudo sysctl -w kernel.sched_rt_runtime_us=950000";
  return finding;
}

}  // namespace

std::string rights_command(const System& system) {
  if (in_container(system)) {
    return "docker run -it --cap-add SYS_NICE --ulimit rtprio=95 --ulimit memlock=-1 IMAGE";
  }
  if (is_there(system, kLimits))
    return "sudo usermod -aG realtime \"$USER\" && exec su - \"$USER\"";
  return fmt::format(
      "sudo groupadd -f realtime && sudo usermod -aG realtime \"$USER\" && "
      "sudo cp {}/palpate-limits.conf /etc/security/limits.d/",
      system.share.string());
}

Findings check_rights(const System& system, const RealtimeReport& report) {
  Findings findings;
  for (const RealtimeRequest& request : report.requests) {
    findings.push_back(granted(system, request));
  }
  findings.push_back(check_limits(system, report));
  findings.push_back(check_share(system));
  return findings;
}

}  // namespace palpate::app::doctor
