// Plays a trial in simulated time and compares what the robot is told with the truth.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/stream.hpp"
#include "robot/allowance.hpp"
#include "robot/trial.hpp"
#include "ros/robot_guide.hpp"

namespace palpate::robot {
namespace {

using Eigen::Vector3d;

constexpr int kTicksALook = 4;      // derived: 250 Hz, a usual robot controller
constexpr double kLate = 0.1;       // s; judgement: three frames at 30 Hz
constexpr double kStiffness = 500;  // N/m; judgement: as in the other benches

// When the frames of a camera arrived and were taken, s.
class Arrivals {
 public:
  void arrived(double now, double stamp) { frames_.push_back({now, stamp}); }
  // When the newest was taken that had arrived by then; 0: there was none.
  [[nodiscard]] double newest(double by) const {
    double stamp = 0;
    for (const auto& [at, taken] : frames_) {
      if (at <= by) stamp = std::max(stamp, taken);
    }
    return stamp;
  }

 private:
  std::vector<std::pair<double, double>> frames_;
};

struct Feed {
  std::unique_ptr<SimulatedCamera> camera;
  std::unique_ptr<SimulatedStream> stream;
};

ros::RobotGuide::Answer old_answer(const ServoState& state) {
  const bool told = !has(state.field_notes, FieldNote::no_surface | FieldNote::behind) &&
                    !has(state.contact.notes, ContactNote::reanchored | ContactNote::not_converged);
  if (!told) return {.reason = "its notes"};
  return {.target = state.tool};
}

class Judge {
 public:
  explicit Judge(const Trial& trial) : arrivals(trial.cameras.size()), trial_(trial) {}

  std::vector<Arrivals> arrivals;  // of the cameras

  void take(const ros::RobotGuide::Answer& answer, const ServoState& state, double now) {
    ++looks_;
    if (answer.reason.empty()) {
      excused_ = false;
    } else if (excused_ = excused_ || newest(now) == 0 || !is_seen(state.contact.proxy, now);
               !excused_) {
      needless_ += kTicksALook * kTick;
    }
    if (!answer.reason.empty()) waits_[std::string(answer.reason)] += kTicksALook * kTick;
    note_patience(answer, state, now);
    if (answer.target) told(answer.target->position, now);
    if (answer.retreats) {
      went_back(answer.target->position, now);
    } else {
      back_.reset();
    }
    if (!answer.target || answer.retreats) {
      last_.reset();
      return;
    }
    if (last_)
      score_.hand_moves =
          std::max(score_.hand_moves,
                   1e3 * ((answer.target->position - *last_).norm() - (state.hip - hip_).norm()));
    last_ = answer.target->position;
    hip_ = state.hip;
  }

  [[nodiscard]] Score score() const {
    Score score = score_;
    double waited = 0;
    for (const auto& [reason, seconds] : waits_) {
      waited += seconds;
      score.reasons +=
          fmt::format("{}{:.1f} s {}", score.reasons.empty() ? "" : ", ", seconds, reason);
    }
    score.needless = needless_ / (static_cast<double>(looks_) * kTicksALook * kTick);
    score.waits = waited / (static_cast<double>(looks_) * kTicksALook * kTick);
    return score;
  }

 private:
  [[nodiscard]] double depth_at(const Vector3d& x, double t) const {
    return robot::depth_at(trial_, x, t);
  }
  [[nodiscard]] double newest(double by) const {
    double stamp = 0;
    for (const Arrivals& of : arrivals) stamp = std::max(stamp, of.newest(by));
    return stamp;
  }
  // How long does the robot wait while hand and tool are in plain sight, and free?
  void note_patience(const ros::RobotGuide::Answer& answer, const ServoState& state, double now) {
    const auto in_sight = [&](const Vector3d& x) {
      return depth_at(x, now) == 0 && is_seen(x, now);
    };
    const bool waits = !answer.reason.empty() && newest(now) > 0;
    const bool needless = waits && in_sight(state.contact.proxy) && in_sight(state.hip);
    sighted_ = needless ? sighted_ + kTicksALook * kTick : 0;
    score_.again = std::max(score_.again, sighted_);
  }
  // Every target counts, whatever the state.
  void told(const Vector3d& target, double now) {
    ++score_.told;
    const double depth = depth_at(target, now);
    const double shown = std::min(depth, depth_at(target, newest(now)));
    score_.deepest = std::max(score_.deepest, depth);
    if (shown > score_.unexcused) {
      score_.unexcused = shown;
      score_.sigma = 1e3 * sigma_at(target);
    }
    note_beyond(target, depth, now);
    const double late = std::min(shown, depth_at(target, newest(now - kLate)));
    score_.late = std::max(score_.late, late);
  }
  void note_beyond(const Vector3d& x, double depth, double now) {
    const Allowance allowed = allowance(trial_, x, now);
    if (depth - allowed.mm <= score_.beyond) return;
    score_.beyond = depth - allowed.mm;
    score_.where =
        fmt::format("beyond at {:.3f} s: {:.1f} mm deep, noise {:.1f}, moved {:.1f} in {:.3f} s",
                    now, depth, allowed.noise, allowed.mm - allowed.noise, allowed.window);
    for (const Arrivals& of : arrivals)
      score_.where += fmt::format(", a frame {:.3f} s old", now - of.newest(now));
  }
  [[nodiscard]] double sigma_at(const Vector3d& x) const {
    double most = 0;
    for (const Watcher& watcher : trial_.cameras) {
      const double z = (watcher.options.T_world_camera.inverse() * x).z();
      most = std::max(most, watcher.options.noise.model.sigma(z));
    }
    return most;
  }
  [[nodiscard]] bool is_seen(const Vector3d& x, double now) const {
    return std::ranges::any_of(trial_.cameras, [&](const Watcher& watcher) {
      return robot::is_seen(trial_, watcher, x, now);
    });
  }
  void went_back(const Vector3d& x, double now) {
    score_.back_depth = std::max(score_.back_depth, depth_at(x, now));
    if (back_)
      score_.back_speed = std::max(score_.back_speed, (x - *back_).norm() / (kTicksALook * kTick));
    back_ = x;
  }

  const Trial& trial_;
  Score score_;
  long looks_ = 0;
  bool excused_ = false;  // the wait that goes on began out of sight
  double needless_ = 0;   // s
  double sighted_ = 0;    // s of the present wait in which all was free and in sight
  std::map<std::string, double> waits_;
  std::optional<Vector3d> last_;
  std::optional<Vector3d> back_;
  Vector3d hip_ = Vector3d::Zero();
};

}  // namespace

Score play(const Trial& trial, Rule rule) {
  Scene scene;
  Judge judge(trial);
  std::deque<Feed> feeds;
  double now = 0;
  for (const Watcher& watcher : trial.cameras) {
    Source& source = scene.add("camera " + std::to_string(feeds.size() + 1),
                               {.T_world_sensor = watcher.options.T_world_camera,
                                .prepare = {.minimum_radius = trial.tool_radius / 0.3}});
    Feed& feed = feeds.emplace_back();
    feed.camera = std::make_unique<SimulatedCamera>(trial.scene, watcher.options);
    feed.stream = std::make_unique<SimulatedStream>(
        *feed.camera, source.name(),
        [&, of = feeds.size() - 1](DepthFrame frame, const Source::StartTime& start) {
          if (watcher.fault && !watcher.fault(frame)) return;
          judge.arrivals[of].arrived(now, frame.stamp);
          source.push(frame, start);
        },
        SimulatedStreamOptions{.latency = watcher.delay + 0.01, .lead = 0.01});
  }
  ros::RobotGuide guide(scene, {.preset = "crisp"}, ros::RobotShape(trial.tool_radius));
  SceneField field(scene, {.tool_radius = trial.tool_radius});
  Proxy proxy({.stiffness = kStiffness});
  ServoState state;
  for (std::size_t i = 0; i < trial.hip.size(); ++i) {
    now = static_cast<double>(i) * kTick;
    for (Feed& feed : feeds) feed.stream->advance(now);
    field.update(now, trial.hip[i], proxy);
    state.contact = proxy.step(field, trial.hip[i], kTick);
    state.tool.position = state.contact.proxy;
    state.field_notes = field.notes();
    state.step = i + 1;
    state.time = now;
    state.hip = trial.hip[i];
    if (i % kTicksALook != 0) continue;
    judge.take(rule == Rule::proxy ? old_answer(state) : guide.look(state, now, false), state, now);
  }
  return judge.score();
}

}  // namespace palpate::robot
