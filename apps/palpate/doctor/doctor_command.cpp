#include "apps/palpate/doctor/doctor_command.hpp"

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/doctor/checks.hpp"

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

void write_json(const doctor::Findings& findings, const std::string& path) {
  OutputFile file(path);
  file.write(text_of(doctor::as_json(findings)));
  file.close();
}

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
  if (!options.json.empty()) write_json(findings, options.json);
  const doctor::Severity severity = doctor::worst(findings);
  if (severity == doctor::Severity::problem) return kFailure;
  return severity == doctor::Severity::warning ? kWarnings : kSuccess;
}

}  // namespace palpate::app
