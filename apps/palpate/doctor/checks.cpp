// The command doctor: runs all checks and prints their findings.
#include "apps/palpate/doctor/checks.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app::doctor {
namespace {

const char* name_of(Severity severity) {
  static constexpr std::array kNames = {"good", "note", "warning", "problem"};
  return kNames[static_cast<std::size_t>(severity)];
}

// Eight characters wide, then coloured: colours have no width.
std::string mark(Severity severity, const Style& style) {
  const std::string padded = fmt::format("{:<8}", name_of(severity));
  if (severity == Severity::problem) return style.error(padded);
  return severity == Severity::warning ? style.warning(padded) : padded;
}

void print(const Finding& finding, const Style& style, std::FILE* stream) {
  fmt::print(stream, "  {} {}: {}\n", mark(finding.severity, style), finding.looked_at,
             finding.words);
  for (const std::string& line : finding.lines) fmt::print(stream, "           {}\n", line);
  if (!finding.remedy.empty()) fmt::print(stream, "           $ {}\n", finding.remedy);
}

std::string counted(const Findings& findings, Severity severity) {
  const auto count = std::ranges::count(findings, severity, &Finding::severity);
  return fmt::format("{} {}{}", count, name_of(severity), count == 1 ? "" : "s");
}

std::string verdict(Severity severity) {
  if (severity == Severity::problem) return "something does not work";
  if (severity == Severity::warning)
    return "palpate works, but perhaps late or not with every device";
  return "no problems found";
}

}  // namespace

void run_checks(std::span<const Check> checks, const Machine& machine, Findings& findings) {
  for (const Check& check : checks) {
    findings.push_back({check.question(machine), check.area, check.what});
  }
}

Findings check_all(const System& system, double jitter) {
  const Machine machine{system, system.try_realtime(jitter), known_usb_devices(system),
                        system.cameras()};
  Findings findings;
  for (const auto& area :
       {check_kernel, check_haptic_devices, check_cameras, check_ros, check_surroundings}) {
    area(machine, findings);
  }
  return findings;
}

Severity worst(const Findings& findings) {
  Severity severity = Severity::good;
  for (const Finding& finding : findings) severity = std::max(severity, finding.severity);
  return severity;
}

void print(const Findings& findings, std::FILE* stream) {
  const Style style(stream);
  std::string area;
  for (const Finding& finding : findings) {
    if (finding.area != area) fmt::print(stream, "{}\n", style.heading(finding.area));
    area = finding.area;
    print(finding, style, stream);
  }
  fmt::print(stream, "{}, {}, {}: {}. The fix for each is shown below it.\n",
             counted(findings, Severity::problem), counted(findings, Severity::warning),
             counted(findings, Severity::note), verdict(worst(findings)));
}

nlohmann::ordered_json as_json(const Findings& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"area", finding.area},
                    {"looked_at", finding.looked_at},
                    {"severity", name_of(finding.severity)},
                    {"words", finding.words},
                    {"remedy", finding.remedy},
                    {"lines", finding.lines}});
  }
  return list;
}

}  // namespace palpate::app::doctor

namespace palpate::app {
namespace {

constexpr int kWarnings = 3;
constexpr double kLongest = 3600;  // s

constexpr const char* kDoctorFooter =
    R"(It changes nothing; it prints commands for you to run.

Examples:
  palpate doctor
  palpate doctor --jitter 60
  palpate doctor --jitter 0 --json -

Exit codes: 0 no problems (notes list what is missing), 1 a problem (something does not work) or the
list could not be written, 2 the command line is wrong, 3 warnings.)";

}  // namespace

void add_doctor_options(CLI::App& command, DoctorOptions& options) {
  command
      .add_option("--jitter", options.jitter,
                  wrapped("how long to measure the jitter of 1 kHz steps; 0: skip"))
      ->check(
          number("from 0 to 3600 s", [](double value) { return value >= 0 && value <= kLongest; }))
      ->type_name("SECONDS")
      ->capture_default_str();
  add_json_option(command, options.json)->group("Output");
  command.footer(kDoctorFooter);
}

int examine(const DoctorOptions& options) {
  const doctor::Findings findings = [&] {
    const Waiting waiting("checking this machine");
    return doctor::check_all(doctor::this_system(), options.jitter);
  }();
  doctor::print(findings, options.json == "-" ? stderr : stdout);
  write_whole(options.json, text_of(doctor::as_json(findings)));
  const doctor::Severity severity = doctor::worst(findings);
  if (severity == doctor::Severity::problem) return kFailure;
  return severity == doctor::Severity::warning ? kWarnings : kSuccess;
}

}  // namespace palpate::app
