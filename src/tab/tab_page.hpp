// Declares the page of a tab.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "session/view_settings.hpp"
#include "tab/tab_run.hpp"
#include "viewer/run_view.hpp"

namespace palpate::tab {

/// The setting by which a person chooses another scene, beside the `present` one.
[[nodiscard]] session::Setting scene_setting(const std::string& present);
/// What its value is opened as.
[[nodiscard]] std::string name_of_scene(const session::Setting::Value& value);

/// A run as the one page of a tab sees it.
class TabPage {
 public:
  /// Scene, servos and stopwatch outlive it. What `options` and `controls` leave open and every tab
  /// has is filled in. `news`: warned of.
  TabPage(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
          const ViewerControls& controls, Outside outside, const Clock& stopwatch,
          std::string news);

  [[nodiscard]] viewer::ClientSessions& sessions() { return view_.sessions(); }
  [[nodiscard]] const Outside& outside() const { return outside_; }

  void connect(double now);
  void receive(std::string_view text, double now);
  /// What there is to tell at `now`.
  void tell(double now);
  /// Says what is wrong; while no page is there, to the next one.
  void warn(const std::string& words);

 private:
  // When what was done last.
  struct Done {
    double states = -1e300;
    double reports = -1e300;
    double next_picture = -1e300;
  };

  void tell_news(double now);
  void flush();
  void leave();

  Outside outside_;
  const Clock& stopwatch_;
  std::vector<std::string> news_;  // not said yet
  viewer::RunView view_;
  viewer::SceneEncoder encoder_;
  std::optional<viewer::Session> page_;
  Done done_;
};

}  // namespace palpate::tab
