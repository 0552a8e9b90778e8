// Steps servos through a recorded run and compares their forces with the recorded ones.
#include "apps/palpate/replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "session/options_json.hpp"
#include "session/recorded_messages.hpp"
#include "stream/source_trace.hpp"

namespace palpate::app {

namespace {

DeviceState device_state(const message::Tick& tick, const std::optional<message::ToolStep>& tool) {
  DeviceState state;
  state.status = static_cast<DeviceState::Status>(tick.status);
  state.time = tick.device_time;
  state.position = message::eigen(tick.position);
  state.velocity = message::eigen(tick.velocity);
  const message::Quaternion& q = tick.orientation;
  state.orientation = {q.w, q.x, q.y, q.z};
  state.buttons = tick.buttons;
  state.gripper = tick.gripper;
  if (tool) state.angular_velocity = message::eigen(tool->angular_velocity);
  return state;
}

void apply(const message::Change& change, Servo& servo) {
  const session::Json value = session::Json::parse(change.value);
  if (change.what == "reset") servo.reset();
  if (change.what == "contact") {
    ContactSettings contact;
    session::take_exact(value, contact);
    servo.set_contact(contact);
  } else if (change.what == "field") {
    FieldOptions field;
    session::take_exact(value, field);
    servo.set_field(field);
  } else if (change.what == "force") {
    Eigen::Vector3d force;
    session::take_exact(value, force);
    servo.add_force(force);
  }
}

double distance(const Eigen::Vector3d& a, const message::Vector3& b) {
  const double norm = (a - message::eigen(b)).norm();
  return std::isnan(norm) ? std::numeric_limits<double>::infinity() : norm;
}

bool is_same(const message::ToolStep& a, const message::ToolStep& b) {
  const auto values = [](const message::ToolStep& step) {
    const auto& [x, y, z, w] = step.orientation;
    return std::array{x, y, z, w, step.opening, step.grip, step.sent_grip};
  };
  return values(a) == values(b) && distance(message::eigen(a.force), b.force) == 0 &&
         distance(message::eigen(a.torque), b.torque) == 0 &&
         distance(message::eigen(a.sent_torque), b.sent_torque) == 0;
}

void compare(const session::Recording::Step& step, const ServoState& state, double start,
             ForceDifference& difference) {
  const message::Tick& tick = step.tick;
  const double error = distance(state.force, tick.force);
  ++difference.steps;
  difference.squares += error * error;
  difference.largest = std::max(difference.largest, error);
  bool same = error == 0;
  if (step.tool) {
    same = same && is_same(session::tool_step_of(state, {}), *step.tool);
    difference.largest_torque = std::max(difference.largest_torque.value_or(0),
                                         distance(state.wrench.torque, step.tool->torque));
  }
  if (same) return;
  if (difference.differing++ > 0) return;
  difference.first = tick.step;
  difference.first_time = tick.time - start;
}

// Why the replay cannot continue with this step, after `done` steps.
std::string words_without(std::uint64_t step, std::uint64_t done) {
  if (done > 0) return fmt::format("the steps before step {} were not recorded", grouped(step));
  return fmt::format(
      "recorded from step {} of its run on: it can be viewed (--view), not done again; use "
      "--record to record a run from its beginning",
      grouped(step));
}

// Pushes what came to one source into a source of another scene.
class SourceReplay {
 public:
  SourceReplay(const session::Recording& recording, std::size_t index, Scene& scene)
      : frames_(recording, index),
        source_(&recording.add_source(index, scene)),
        lives_(recording.sources()[index].lives) {
    const session::Recording::Origin& origin = recording.sources()[index];
    from_.plan.argument.name = origin.name;
    from_.plan.options = origin.options;
    from_.plan.as_cloud = origin.as_cloud;
  }

  // Pushes until so many snapshots are published; false: the file does not have what they need.
  [[nodiscard]] bool push_until(std::uint64_t publication) {
    while (done_ < publication) {
      const std::optional<session::RecordedFrame> frame = lives_ ? frames_.next() : std::nullopt;
      if (!frame || frame->use.gap) return false;
      push(*frame);
    }
    return SourceTrace(*source_).publications() == done_;
  }

  // `least_radius`: how wide its supports were at least, m.
  void widen(double least_radius) { SourceTrace(*source_).impose_least_radius(least_radius); }

 private:
  void push(const session::RecordedFrame& recorded) {
    const message::FrameUse& use = recorded.use;
    done_ = use.publication;
    if (!use.options.empty()) {
      SourceOptions options;
      session::take_exact(session::Json::parse(use.options), options);
      source_->change(options);
    }
    if (use.dropped) return;
    std::vector<Reach> reach;
    for (std::size_t i = 0; i + 3 < use.reach.size(); i += 4) {
      reach.push_back({Eigen::Vector3d(use.reach.data() + i), use.reach[i + 3]});
    }
    SourceTrace(*source_).impose_reach(reach);
    if (use.kind == "end") return source_->keep();
    try {
      push_frame(from_, *source_, recorded.frame, [&] { return use.start; });
    } catch (const Error&) {
      if (use.why_not.empty()) throw;  // else it was refused in the run, too
    }
  }

  session::Recording::Frames frames_;
  LoadedSource from_;
  Source* source_;
  bool lives_;
  std::uint64_t done_ = 0;  // publications
};

// Steps one hand on a scene of its own.
class HandReplay {
 public:
  HandReplay(const session::Recording& recording, std::size_t hand)
      : steps_(recording, hand), device_(recording.hands().at(hand).device) {
    for (std::size_t i = 0; i < recording.sources().size(); ++i) {
      sources_.emplace_back(recording, i, scene_);
    }
    servo_.emplace(device_, scene_, recording.hands()[hand].options);
    difference_.topic = recording.hands()[hand].topic;
  }

  ForceDifference run(const Replay::EachStep& each) {
    std::string& ended = difference_.ended;
    while (ended.empty()) {
      const std::optional<session::Recording::Step> step = steps_.next();
      if (!step) break;
      for (const message::Change& change : step->changes) apply(change, *servo_);
      take(*step, each);
    }
    const std::vector<std::string>& losses = steps_.losses();
    if (ended.empty() && !losses.empty()) ended = "damaged: " + losses.front();
    if (ended.empty() && difference_.steps == 0) ended = "there is no step";
    return difference_;
  }

 private:
  void take(const session::Recording::Step& recorded, const Replay::EachStep& each) {
    const message::Tick& tick = recorded.tick;
    if (tick.step != difference_.steps + 1) {
      difference_.ended = words_without(tick.step, difference_.steps);
      return;
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (sources_[i].push_until(tick.publications.at(i))) continue;
      difference_.ended =
          fmt::format("what source {} showed in step {} was not recorded", i + 1, tick.step);
      return;
    }
    // Pushing may have compared sources.
    for (std::size_t i = 0; i < sources_.size(); ++i) sources_[i].widen(tick.least_radii.at(i));
    if (difference_.steps == 0) start_ = tick.time;
    servo_->pause(tick.paused);
    const double begin = thread_cpu_seconds();
    ServoState state = servo_->step(device_state(tick, recorded.tool), tick.time);
    state.timing.computing = thread_cpu_seconds() - begin;
    servo_->show();
    compare(recorded, state, start_, difference_);
    state.time -= start_;
    each(state, device_.info());
  }

  session::Recording::Steps steps_;
  Scene scene_;
  std::deque<SourceReplay> sources_;
  session::RecordedDevice device_;
  std::optional<Servo> servo_;
  double start_ = 0;  // of the first step, s
  ForceDifference difference_;
};

// Does `work` on the file `path`.
void guarded(const std::string& path, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: damaged: {}", path, error.what()));
  }
}

}  // namespace

double ForceDifference::rms() const {
  return steps > 0 ? std::sqrt(squares / static_cast<double>(steps)) : 0;
}

ForceDifference Replay::run(std::size_t hand, const EachStep& each) const {
  ForceDifference difference;
  guarded(recording_.path(), [&] { difference = HandReplay(recording_, hand).run(each); });
  return difference;
}

void Replay::show(std::size_t hand, const EachStep& each) const {
  guarded(recording_.path(), [&] {
    const session::Recording::Hand& its = recording_.hands().at(hand);
    session::Recording::Steps steps(recording_, hand);
    std::optional<double> start;
    while (const std::optional<session::Recording::Step> step = steps.next()) {
      ServoState state = session::state_of(step->tick, step->tool, its.options);
      if (!start) start = state.time;
      state.time -= *start;
      each(state, its.device);
    }
  });
}

}  // namespace palpate::app
