#include "apps/palpate/doctor/checks.hpp"

#include <algorithm>
#include <iterator>

#include "apps/palpate/doctor/camera_drivers.hpp"
#include "apps/palpate/doctor/devices.hpp"
#include "apps/palpate/doctor/jitter.hpp"
#include "apps/palpate/doctor/kernel.hpp"
#include "apps/palpate/doctor/rights.hpp"
#include "apps/palpate/doctor/surroundings.hpp"
#include "apps/palpate/doctor/vendor_libraries.hpp"

namespace palpate::app::doctor {

namespace {

void append(Findings& findings, const Findings& more) {
  findings.insert(findings.end(), more.begin(), more.end());
}

// An area's findings together, areas in the order of their first.
void gather_areas(Findings& findings) {
  std::vector<std::string> areas;
  for (const Finding& finding : findings) areas.push_back(finding.area);
  const auto place = [&areas](const Finding& finding) {
    return std::ranges::find(areas, finding.area) - areas.begin();
  };
  std::ranges::stable_sort(findings, {}, place);
}

}  // namespace

Severity worst(const Findings& findings) {
  Severity severity = Severity::good;
  for (const Finding& finding : findings) severity = std::max(severity, finding.severity);
  return severity;
}

Findings check_all(const System& system, double jitter) {
  const RealtimeTrial trial = system.try_realtime(jitter);
  Findings findings = {check_preemption(system), check_governor(system),
                       check_clock_source(system)};
  if (trial.lateness.count > 0) findings.push_back(check_jitter(system, trial));
  append(findings, check_rights(system, trial.report));
  const std::vector<Found> found = known_among(usb_devices(system));
  append(findings, check_devices(system, found));
  append(findings, check_vendor_libraries(system, found));
  append(findings, check_camera_drivers(system, found));
  append(findings, {check_installation(system), check_runtime_folder(system), check_locales(system),
                    check_decimal_point(system), check_network_buffer(system),
                    check_matplotlib(system), check_browser(system)});
  gather_areas(findings);
  return findings;
}

}  // namespace palpate::app::doctor
