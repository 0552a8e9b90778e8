#include "apps/palpate/report/touch_report.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/report/source_report.hpp"

namespace palpate::app {

namespace {

std::string subtitle(const HandReport& report) {
  const TouchStatistics& s = report.statistics;
  return fmt::format(
      "{} field, K = {:.4g} N/m, {} steps in {:.3g} s, {} contacts, energy given to the "
      "hand {}",
      name_in(kFields, report.field.kind), report.stiffness, grouped(s.steps()), s.duration(),
      grouped(s.contacts()), energy(energy_at_hand(report).given));
}

}  // namespace

HandOutputs::HandOutputs(const OutputPlan& outputs, std::size_t hand) {
  if (!outputs.log.empty()) log_.emplace(numbered_path(outputs.log, hand));
  if (!outputs.picture.empty()) picture_.emplace(numbered_path(outputs.picture, hand));
}

void HandOutputs::add(const ServoState& step, const DeviceInfo& device) {
  statistics_.add(step);
  if (log_) log_->add(step, device);
  if (picture_) picture_->add(step);
}

void HandOutputs::close_log() {
  if (log_) log_->close();
}

void HandOutputs::draw(const Scene& scene, const std::string& title, const HandReport& report) {
  if (picture_) picture_->draw(scene, title, subtitle(report));
}

// What is of a hand stands beside what is of the run where there is one hand, else under "hands".
Json report_on(const TouchReport& report, std::FILE* stream) {
  Json sources = Json::array();
  for (const LoadedSource& source : report.loaded.sources) {
    const Report part = source_report(source);
    part.print(stream);
    sources.push_back(part.data);
  }
  Json json = {{"palpate", std::string(version())},
               {"sources", sources},
               {"preset", report.paper ? "paper" : "default"},
               {"field", name_in(kFields, report.field.kind)},
               {"stiffness_N_per_m", report.proxy.stiffness}};
  const bool alone = report.hands.size() == 1;
  for (const HandReport& each : report.hands) {
    const Report part = report_of(each, alone ? "touched" : each.hand.name);
    part.print(stream);
    if (alone) {
      json.update(part.data);
    } else {
      json["hands"].push_back(part.data);
    }
  }
  return json;
}

}  // namespace palpate::app
