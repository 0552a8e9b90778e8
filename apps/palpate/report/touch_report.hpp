#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/report/hand_report.hpp"
#include "apps/palpate/report/log.hpp"
#include "apps/palpate/report/picture.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {

/// What is kept of one hand's steps.
class HandOutputs {
 public:
  /// The files that `outputs` names for the hand of that index, made at once.
  /// @throws Error when they cannot be.
  HandOutputs(const OutputPlan& outputs, std::size_t hand);

  void add(const ServoState& step, const DeviceInfo& device);
  void close_log();

  /// @throws Error as Picture::draw() does.
  void draw(const Scene& scene, const std::string& title, const HandReport& report);

  [[nodiscard]] const TouchStatistics& statistics() const { return statistics_; }

 private:
  TouchStatistics statistics_;
  std::optional<TouchLog> log_;
  std::optional<Picture> picture_;
};

/// Everything that a run's report tells.
struct TouchReport {
  const LoadedScene& loaded;  ///< as the run left it
  bool paper = false;         ///< the preset paper
  FieldOptions field;
  ProxyOptions proxy;
  std::vector<HandReport> hands;
};

/// For a person, to `stream`; the same as data: SI units, named in the keys. What is of a hand is
/// in `hands`, where there are several.
Json report_on(const TouchReport& report, std::FILE* stream);

}  // namespace palpate::app
