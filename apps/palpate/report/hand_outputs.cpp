#include "apps/palpate/report/hand_outputs.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"

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

HandOutputs::HandOutputs(const TouchOptions& options, std::size_t hand) {
  if (!options.log.empty()) log_.emplace(numbered_path(options.log, hand));
  if (!options.picture.empty()) picture_.emplace(numbered_path(options.picture, hand));
}

void HandOutputs::add(const TouchStep& step) {
  statistics_.add(step);
  if (log_) log_->add(step);
  if (picture_) picture_->add(step);
}

void HandOutputs::close_log() {
  if (log_) log_->close();
}

void HandOutputs::draw(const Scene& felt, const std::string& title, const HandReport& report) {
  if (picture_) picture_->draw(felt, title, subtitle(report));
}

}  // namespace palpate::app
