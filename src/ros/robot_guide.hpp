#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/ros/bridge.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "ros/robot_shape.hpp"

namespace palpate::ros {

/// Decides where a robot may go: to the proxy, where a camera sees that all of it is free, or on a
/// surface from its front. Else it waits at its last target, and goes back towards the camera when
/// what is seen comes over it no faster than it may go back; no target lies in what the newest
/// frame shows. It follows again once hand and proxy have been seen free for half a second, or the
/// dead man's button is pressed again. One thread calls it.
class RobotGuide {
 public:
  /// The scene outlives it. `shape`: what has to be free.
  /// @throws Error when the scene has no source of a name in `options.sources`.
  RobotGuide(const Scene& scene, const RosBridgeOptions::Robot& options, RobotShape shape);

  struct Answer {
    std::optional<Pose> target = {};  ///< unset: no target is sent
    bool retreats = false;            ///< the target leads back
    std::string_view reason = {};     ///< why it does not follow; empty: it does
    std::string why = {};             ///< the same with its numbers
    double age = 0;                   ///< of the frame that shows a target that it follows, s
  };

  /// Called some hundred times a second. `now`: s, on the clock of the sources' stamps. `pressed`:
  /// the dead man's button was up before, and what is on the path is the user's to see.
  [[nodiscard]] Answer look(const ServoState& state, double now, bool pressed);

  /// No target is sent now, for other reasons; then it waits for the half second, or the button.
  void pause();

  /// There are no data of the hand now: for less than 20 ms that changes nothing. After more, what
  /// was seen before does not count, and it goes on where proxy and path are seen free.
  void miss_hand(double now);

  /// The robot is there, whatever target was answered last.
  void is_at(const std::optional<Pose>& pose);

 private:
  // What came last over the tool, or over the robot.
  struct Memory {
    const Source* source = nullptr;                          // that saw it come; null: none did
    double came = -std::numeric_limits<double>::infinity();  // when, s
    Pose where = {};                                         // over this pose
  };

  // The sources' answer about one pose.
  struct Verdict {
    const Source* source = nullptr;  // that decided; null: there is no camera
    Seen seen = {};

    [[nodiscard]] bool free() const { return seen.verdict == Seen::Verdict::free; }
    [[nodiscard]] bool solid() const { return seen.verdict == Seen::Verdict::solid; }
    [[nodiscard]] bool sighted() const { return free() || solid(); }
  };

  [[nodiscard]] Verdict judge(const Pose& pose, double now, Memory& memory) const;
  [[nodiscard]] bool is_outrun(const Seen& seen, const ServoState& state) const;
  [[nodiscard]] double allowed_ahead(const ServoState& state, const Verdict& proxy, double dt);
  [[nodiscard]] std::string_view hindrance(const Pose& target, double now) const;
  [[nodiscard]] bool comes_out(Pose& target, double now) const;
  [[nodiscard]] bool may_start(bool pressed) const;
  void count_free(double dt);
  void note(const Verdict& hand, bool proxy_free, double dt, bool pressed);
  // `stamp`: of the newest frame, which shows the target free, s.
  [[nodiscard]] Answer follow(const Pose& target, double stamp, double ahead = 0);
  // `hindrance`: why it waits though the proxy is free.
  [[nodiscard]] Answer wait(const Verdict& proxy, double now, double dt,
                            std::string_view hindrance);
  void note_held(const Verdict& held, double now);
  bool note_clear(double stamp);
  [[nodiscard]] bool goes_back(Verdict held, double now, double dt);
  void forget();
  [[nodiscard]] Answer without_view(const ServoState& state, double dt, bool pressed);

  // Surface or obstacle that came over the waiting robot.
  struct Over {
    std::string_view what = {};  // empty: nothing
    double since = 0;            // s
  };

  struct Robot {
    std::optional<Pose> pose = {};  // where it is, world
    Memory memory = {};
    double clear = 0;  // stamp of the last frame that showed nothing over it, s
    double gone = 0;   // how far it has gone back since then, m
    double seen = 0;   // when it was seen last, s
    Over over = {};
  };

  const RosBridgeOptions::Robot options_;
  const RobotShape shape_;
  const std::vector<const Source*> sources_;  // that count
  Robot robot_;
  Memory tool_;
  bool follows_ = true;
  double speed_ = 0;  // of the touched surface towards the camera, the highest lately, m/s
  double ahead_ = 0;  // from the proxy to the last target, towards the camera, m
  std::optional<double> free_for_;  // s in which hand and proxy were seen free; unset: they are not
  double sighted_ = 0;              // when both were seen last, s
  double followed_ = 0;  // when it followed last, s; -infinite: something was solid since
  double looked_ = 0;    // when look() was called last, s
};

}  // namespace palpate::ros
