#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/report/hand_report.hpp"
#include "apps/palpate/report/log.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// Collects the steps of a run and draws them with the clouds, by a script for Python with
/// matplotlib that travels inside the program.
class Picture {
 public:
  /// @throws Error when the file cannot be made.
  explicit Picture(const std::string& path) : path_(path), file_(path) {}

  void add(const ServoState& step) { steps_.push_back(step); }

  /// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
  void draw(const Scene& scene, const std::string& title, const std::string& subtitle);

 private:
  std::string path_;
  OutputFile file_;
  std::vector<ServoState> steps_;
};

/// Statistics, log and picture of one hand's steps.
class HandOutputs {
 public:
  /// The files that `outputs` names for the hand of that index, made at once. `turns`: it holds a
  /// tool that turns. @throws Error when they cannot be.
  HandOutputs(const OutputPlan& outputs, std::size_t hand, bool turns);

  /// @throws Error once, when the log cannot be written; the rest goes on.
  void add(const ServoState& step, const Hand& hand);
  /// Why the log is not whole; empty: it is, or there is none.
  [[nodiscard]] std::string close_log();

  /// @throws Error as Picture::draw() does.
  void draw(const Scene& scene, const std::string& title, const HandReport& report);

  [[nodiscard]] const TouchStatistics& statistics() const { return statistics_; }

 private:
  TouchStatistics statistics_;
  std::optional<TouchLog> log_;
  std::optional<Picture> picture_;
};

/// Everything that a run's report contains.
struct TouchReport {
  const LoadedScene& loaded;  ///< as the run left it
  bool paper = false;         ///< the preset paper
  FieldOptions field;
  ProxyOptions proxy;
  std::vector<HandReport> hands;
  std::optional<RosBridge::RobotState> robot = {};
  std::vector<RecordReport> recorded = {};  ///< files, in order
};

/// "robot WAITS: the surface passed over the tool 0.4 s ago".
[[nodiscard]] std::string in_words(const RosBridge::RobotState& robot);

/// For a person, to `stream`; the same as data: SI units, named in the keys. What is of a hand is
/// in `hands`, where there are several.
Json report_on(const TouchReport& report, std::FILE* stream);

}  // namespace palpate::app
