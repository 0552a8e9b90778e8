// Declares what pages see of a run and do to it, without sockets and threads.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "palpate/viewer/viewer.hpp"
#include "viewer/client_sessions.hpp"
#include "viewer/reports.hpp"
#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {

/// A scene and its servos as all pages see them. Depends on neither sockets nor clocks; one thread
/// uses it.
class RunView {
 public:
  static constexpr double kStatePeriod = 1.0 / 60;  ///< s; a screen's frame (judgement)
  static constexpr double kReportPeriod = 0.5;      ///< s (judgement)

  /// Scene and servos outlive it; what `options` and `controls` leave open is filled in.
  /// @throws Error as Viewer's constructor does, but for address and port.
  RunView(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
          ViewerControls controls);
  RunView(const RunView&) = delete;
  RunView& operator=(const RunView&) = delete;

  [[nodiscard]] ClientSessions& sessions() { return sessions_; }
  [[nodiscard]] const ViewerOptions& options() const { return options_; }
  /// For those who make its pictures.
  [[nodiscard]] SceneEncoderOptions encoding() const;

  /// Point budgets of the pages that are there; empty: nobody looks.
  [[nodiscard]] std::set<std::size_t> budgets() const;
  /// Sends the newest states at `now`, s, where somebody looks: to be called every kStatePeriod.
  void send_states(double now);
  /// Sends what is wrong with streams and devices, where somebody looks: every kReportPeriod.
  void send_faults();
  void show(const EncodedScene& encoded);
  /// Reports long work, done from 0 to 1, to pages that come later, too.
  void show_progress(std::string what, double share);

 private:
  [[nodiscard]] ClientSessionsOptions sessions_options(const ViewerControls& controls);
  [[nodiscard]] std::vector<ViewedStream> streams() const;
  [[nodiscard]] Welcome welcome();
  void check_faults(const std::vector<ViewedStream>& streams);

  Scene& scene_;
  std::vector<Servo*> servos_;
  std::vector<std::string> names_;  // of their tools
  ViewerOptions options_;
  std::string run_;
  ClientSessions sessions_;
  std::vector<StateReporter> states_;
  std::vector<double> radii_;  // R around each tool, m
  FaultNotices notices_;
  std::optional<Notice> progress_;  // of work under way
};

}  // namespace palpate::viewer
