#pragma once

#include <optional>
#include <string>

#include "apps/palpate/report/hand_report.hpp"
#include "apps/palpate/report/log.hpp"
#include "apps/palpate/report/picture.hpp"

namespace palpate::app {

/// What is kept of one hand's steps.
class HandOutputs {
 public:
  /// The files that `outputs` names for the hand of that index, made at once.
  /// @throws Error when they cannot be.
  HandOutputs(const OutputPlan& outputs, std::size_t hand);

  void add(const TouchStep& step);
  void close_log();

  /// @throws Error as Picture::draw() does.
  void draw(const Scene& felt, const std::string& title, const HandReport& report);

  [[nodiscard]] const TouchStatistics& statistics() const { return statistics_; }

 private:
  TouchStatistics statistics_;
  std::optional<TouchLog> log_;
  std::optional<Picture> picture_;
};

}  // namespace palpate::app
