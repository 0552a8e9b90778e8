#include "apps/palpate/replay/replayed_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/record/recording_file.hpp"
#include "apps/palpate/replay/recorded_hand.hpp"
#include "apps/palpate/replay/replayed_source.hpp"
#include "bag/mcap_reader.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

DeviceState device_state(const message::Tick& tick) {
  DeviceState state;
  state.status = static_cast<DeviceState::Status>(tick.status);
  state.time = tick.device_time;
  state.position = message::eigen(tick.position);
  state.velocity = message::eigen(tick.velocity);
  const message::Quaternion& q = tick.orientation;
  state.orientation = {q.w, q.x, q.y, q.z};
  state.buttons = tick.buttons;
  state.gripper = tick.gripper;
  return state;
}

void apply(const message::Change& change, Servo& servo) {
  const Json value = Json::parse(change.value);
  if (change.what == "reset") servo.reset();
  if (change.what == "contact") {
    ContactSettings contact;
    take_exact(value, contact);
    servo.set_contact(contact);
  } else if (change.what == "field") {
    FieldOptions field;
    take_exact(value, field);
    servo.set_field(field);
  } else if (change.what == "force") {
    Eigen::Vector3d force;
    take_exact(value, force);
    servo.add_force(force);
  }
}

void compare(const message::Tick& tick, const Eigen::Vector3d& force, double start,
             ForceDifference& difference) {
  const double norm = (force - message::eigen(tick.force)).norm();
  const double error = std::isnan(norm) ? std::numeric_limits<double>::infinity() : norm;
  ++difference.steps;
  difference.squares += error * error;
  difference.largest = std::max(difference.largest, error);
  if (error == 0) return;
  if (difference.differing++ > 0) return;
  difference.first = tick.step;
  difference.first_time = tick.time - start;
}

// Why it cannot be gone on with this step, `done` having been done.
std::string words_without(std::uint64_t step, std::uint64_t done) {
  if (done > 0) return fmt::format("the steps before step {} were not recorded", grouped(step));
  return fmt::format(
      "recorded from step {} of its run on: it can be viewed (--view), not done again; use "
      "--record "
      "to record a run from its beginning",
      grouped(step));
}

// One hand on a scene of its own.
class ReplayedHand {
 public:
  ReplayedHand(const std::string& path, const Json& setup, const Json& json)
      : reader_(path), device_(json.at("device")) {
    for (std::size_t i = 0; i < setup.at("sources").size(); ++i) {
      sources_.emplace_back(path, setup.at("sources").at(i), i, scene_, reader_);
    }
    ServoOptions options;
    take_exact(json.at("options"), options);
    servo_.emplace(device_, scene_, options);
    const std::string topic = json.at("topic").get<std::string>() + "/";
    reader_.choose([&](const bag::Channel& each) { return each.topic.starts_with(topic); });
  }

  ForceDifference run(const ReplayedRun::EachStep& each) {
    ForceDifference difference;
    for (bag::Message message; difference.ended.empty() && reader_.next(message);) {
      const std::string& type = reader_.channel_of(message).schema.name;
      if (type == message::ros_name(message::Change::kName)) {
        message::Change change;
        message::decode(message.data, change);
        apply(change, *servo_);
      } else if (type == message::ros_name(message::Tick::kName)) {
        message::Tick tick;
        message::decode(message.data, tick);
        step(tick, difference, each);
      }
    }
    const std::vector<std::string>& losses = reader_.contents().losses;
    if (difference.ended.empty() && !losses.empty())
      difference.ended = "damaged: " + losses.front();
    if (difference.steps == 0 && difference.ended.empty()) difference.ended = "there is no step";
    return difference;
  }

 private:
  void step(const message::Tick& tick, ForceDifference& difference,
            const ReplayedRun::EachStep& each) {
    if (tick.step != difference.steps + 1) {
      difference.ended = words_without(tick.step, difference.steps);
      return;
    }
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      if (sources_[i].push_until(tick.publications.at(i))) continue;
      difference.ended =
          fmt::format("what source {} showed in step {} was not recorded", i + 1, tick.step);
      return;
    }
    // Pushing may have compared sources.
    for (std::size_t i = 0; i < sources_.size(); ++i) sources_[i].widen(tick.least_radii.at(i));
    if (difference.steps == 0) start_ = tick.time;
    servo_->pause(tick.paused);
    const double begin = thread_cpu_seconds();
    ServoState state = servo_->step(device_state(tick), tick.time);
    state.timing.computing = thread_cpu_seconds() - begin;
    servo_->show();
    compare(tick, state.force, start_, difference);
    state.time -= start_;
    each(state, device_.info());
  }

  bag::McapReader reader_;
  Scene scene_;
  std::deque<ReplayedSource> sources_;
  RecordedDevice device_;
  std::optional<Servo> servo_;
  double start_ = kNotANumber;  // s
};

}  // namespace

double ForceDifference::rms() const {
  return steps > 0 ? std::sqrt(squares / static_cast<double>(steps)) : 0;
}

Json recorded_setup(const bag::McapReader& reader, const std::string& path) {
  try {
    const bag::Attachment text = attachment_named(reader, kSetupName);
    Json setup = Json::parse(text.data.begin(), text.data.end());
    if (setup.at("kind") != kSetupKind) throw Error("another version of palpate recorded it");
    if (!setup.at("hands").is_array() || setup["hands"].empty()) throw Error("no hand is in it");
    return setup;
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: no recording of a run: {}", path, error.what()));
  }
}

ReplayedRun::ReplayedRun(const std::string& path) : path_(path) {
  setup_ = recorded_setup(bag::McapReader(path), path);
}

ForceDifference ReplayedRun::replay(std::size_t hand, const EachStep& each) const {
  const Json& json = setup_.at("hands").at(hand);
  try {
    ReplayedHand replayed(path_, setup_, json);
    ForceDifference difference = replayed.run(each);
    difference.topic = json.at("topic").get<std::string>();
    return difference;
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: damaged: {}", path_, error.what()));
  }
}

void ReplayedRun::recorded(std::size_t hand, const EachStep& each) const {
  RecordedHand steps(path_, bag::McapReader(path_), setup_, hand);
  const RecordedDevice device(setup_.at("hands").at(hand).at("device"));
  double start = kNotANumber;
  while (std::optional<ServoState> step = steps.next()) {
    if (std::isnan(start)) start = step->time;
    step->time -= start;
    each(*step, device.info());
  }
}

}  // namespace palpate::app
