// A run in real time.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/touch/live_status.hpp"
#include "apps/palpate/touch/touch.hpp"
#include "apps/palpate/view/view.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kLook{20};

constexpr double kQueue = 4;  // s of steps that writing them down may fall behind

// A trajectory may have few rows or many; the clock has its own.
double rate_of(const Hand& hand) {
  return std::clamp(hand.device->info().rate, ServoThread::kLeastRate, ServoThread::kMostRate);
}

// What one read catches up of a hand that a page moves: for longer, it waits for the servo.
constexpr int kPageSteps = 5;

Device& paced_by(std::optional<PacedDevice>& paced, const Hand& hand, const Clock& clock) {
  Device& device = *hand.device;
  if (!device.info().keeps_time) return device;
  return paced.emplace(device, clock, hand.remote ? kPageSteps : PacedDevice::kMostSteps);
}

// One hand of a run in real time: its servo, on a thread of its own from construction on. The
// thread that made it calls all the rest.
class LiveHand {
 public:
  // Run and clock outlive it. @throws Error when there is no thread to be had.
  LiveHand(Run& run, std::size_t index, WaitingClock& clock);
  LiveHand(const LiveHand&) = delete;
  LiveHand& operator=(const LiveHand&) = delete;

  // The run's time 0, s on the clock. What came before is left out.
  void begin(double start);

  // Hands its steps up to the time `until` (s on the clock), and at most one after it, to `each`,
  // with times from 0. Reports in `status` what `each` throws, and goes on.
  void take_steps(double until, const EachStep& each, LiveStatus& status);

  // Has it come to its end, whatever ended it?
  [[nodiscard]] bool over(double now) const;

  // Why its device failed; empty: it did not.
  [[nodiscard]] std::string failure() const;

  // How it goes since the moment before.
  [[nodiscard]] HandMoment moment(double now);

  // Ends the thread: zero force. Its last steps can be taken then.
  void stop() { thread_.stop(); }
  [[nodiscard]] LiveReport report() const;

  [[nodiscard]] Servo& servo() { return servo_; }

 private:
  Hand& hand_;
  std::size_t index_;
  double rate_;
  std::optional<PacedDevice> paced_;  // of a device that defines its own time
  ServoState::Queue steps_;
  Servo servo_;
  double start_ = 0;
  double looked_ = 0;
  double force_ = 0;  // the longest since then, N
  StepDurations durations_;
  ServoThread thread_;  // last: it uses all of the above
};

LiveHand::LiveHand(Run& run, std::size_t index, WaitingClock& clock)
    : hand_(run.hands[index]),
      index_(index),
      rate_(rate_of(hand_)),
      steps_(static_cast<std::size_t>(kQueue * rate_)),
      servo_(paced_by(paced_, hand_, clock), run.loaded.scene, servo_options(run, hand_, &steps_)),
      thread_(servo_, clock, run.time.realtime, rate_) {}

void LiveHand::begin(double start) {
  start_ = start;
  looked_ = start;
}

void LiveHand::take_steps(double until, const EachStep& each, LiveStatus& status) {
  for (bool more = true; more;) {
    std::optional<ServoState> step = steps_.pop();
    if (!step) return;
    more = step->time <= until;
    if (step->time < start_) continue;
    step->time -= start_;
    force_ = std::max(force_, step->force.norm());
    try {
      each(index_, *step);
    } catch (const Error& error) {
      status.print(error.what() + std::string("; the run goes on"));
    }
  }
}

bool LiveHand::over(double now) const {
  return !thread_.running() || (hand_.duration && now - start_ >= *hand_.duration);
}

std::string LiveHand::failure() const {
  if (thread_.running() || servo_.state().device != DeviceState::Status::failed) return {};
  return fmt::format("{}: device '{}' failed: {}", hand_.name, hand_.device->info().name,
                     hand_.device->reason());
}

HandMoment LiveHand::moment(double now) {
  HandMoment moment;
  moment.name = hand_.name;
  moment.servo = servo_.state();
  moment.force = std::exchange(force_, 0);
  const StepDurations durations = servo_.durations();
  moment.durations = durations.since(std::exchange(durations_, durations));
  const double span = now - std::exchange(looked_, now);
  moment.rate = span > 0 ? static_cast<double>(moment.durations.computing.count) / span : 0;
  if (moment.servo.device == DeviceState::Status::silent) moment.silence = hand_.device->reason();
  moment.ended = !thread_.running();
  return moment;
}

LiveReport LiveHand::report() const {
  LiveReport report;
  report.realtime = thread_.realtime();
  report.rate = rate_;
  report.lateness = servo_.durations().lateness;
  report.skipped = thread_.skipped();
  report.unwritten = steps_.dropped();
  report.limits = servo_.options().guard;
  report.guard = servo_.state().guard;
  report.failure = failure();
  return report;
}

using LiveHands = std::deque<LiveHand>;

// Returns the time at which all of them were there.
double start_hands(Run& run, WaitingClock& clock, LiveHands& hands) {
  for (std::size_t i = 0; i < run.hands.size(); ++i) hands.emplace_back(run, i, clock);
  const double start = clock.now();
  for (LiveHand& hand : hands) hand.begin(start);
  return start;
}

// `until`: now, while they go on: where writing a step takes longer than the step itself, there is
// always a next one.
void take_steps(LiveHands& hands, double until, const EachStep& each, LiveStatus& status) {
  for (LiveHand& hand : hands) hand.take_steps(until, each, status);
}

std::vector<Servo*> servos_of(LiveHands& hands) {
  std::vector<Servo*> servos;
  for (LiveHand& hand : hands) servos.push_back(&hand.servo());
  return servos;
}

std::vector<const Servo*> watched(LiveHands& hands) {
  const std::vector<Servo*> servos = servos_of(hands);
  return {servos.begin(), servos.end()};
}

bool any_goes_on(const LiveHands& hands, double now) {
  return std::ranges::any_of(hands, [now](const LiveHand& hand) { return !hand.over(now); });
}

LiveMoment moment_of(LiveHands& hands, const LiveFeed& feed,
                     std::optional<RosBridge::RobotState> robot, double time, double now) {
  LiveMoment moment;
  moment.time = time;
  moment.robot = std::move(robot);
  for (LiveHand& hand : hands) moment.hands.push_back(hand.moment(now));
  moment.streams = feed.states();
  moment.prepared = feed.prepared();
  return moment;
}

// Reports once of each hand that its device failed, where others go on, and of a cloud what of it
// cannot be read.
class FailureWatch {
 public:
  void look(const LiveHands& hands, const LiveFeed& feed, double now, LiveStatus& status) {
    const std::vector<std::string> problems = feed.problems();
    for (; problems_ < problems.size(); ++problems_) status.print(problems[problems_]);
    reported_.resize(hands.size());
    if (!any_goes_on(hands, now)) return;
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const std::string failure = reported_[i] ? "" : hands[i].failure();
      if (failure.empty()) continue;
      reported_[i] = true;
      status.print(failure + "; it gets no more force, the other hands continue");
    }
  }

 private:
  std::vector<bool> reported_;
  std::size_t problems_ = 0;  // of the feed, reported
};

// Topics are named hand, or hand1, hand2, ... where there are several.
std::vector<RosBridge::Hand> ros_hands(LiveHands& hands) {
  std::vector<RosBridge::Hand> found;
  for (LiveHand& hand : hands) {
    const std::string number = hands.size() > 1 ? std::to_string(found.size() + 1) : "";
    found.push_back({"hand" + number, &hand.servo()});
  }
  return found;
}

}  // namespace

LiveOutcome run_live(Run& run, WaitingClock& clock, const Interruption& interruption,
                     const EachStep& each) {
  LiveStatus status;
  FailureWatch failures;
  LiveHands hands;
  // Setting them up may take half a second; recordings begin when the hands do.
  const double start = start_hands(run, clock, hands);
  if (run.recorder != nullptr) run.recorder->begin(run.loaded, watched(hands), start, false);
  LiveFeed feed(run.loaded, clock, start, run.recorder);
  std::optional<RosBridge> bridge;
  std::optional<View> view;
  LiveOutcome outcome;
  if (run.ros.wanted()) {
    bridge.emplace(
        ros_hands(hands), run.loaded.scene, [&] { return feed.states(); }, run.ros.options());
  }
  const auto robot = [&] { return bridge ? bridge->robot() : std::nullopt; };
  if (run.page.served) view.emplace(run, servos_of(hands), feed, bridge ? &*bridge : nullptr);
  while (any_goes_on(hands, clock.now()) && !interruption.requested() && !outcome.next_page) {
    std::this_thread::sleep_for(kLook);
    take_steps(hands, clock.now(), each, status);
    if (view) outcome.next_page = view->look();
    const double now = clock.now();
    failures.look(hands, feed, now, status);
    if (run.recorder != nullptr) run.recorder->note(now, robot());
    if (!status.due(now - start)) continue;
    status.show(moment_of(hands, feed, robot(), now - start, now));
  }
  outcome.robot = robot();  // before its hand stands still
  for (LiveHand& hand : hands) hand.stop();
  take_steps(hands, std::numeric_limits<double>::infinity(), each, status);
  for (const LiveHand& hand : hands) outcome.hands.push_back(hand.report());
  outcome.interrupted = interruption.requested();
  failures.look(hands, feed, clock.now(), status);
  if (bridge && !bridge->problem().empty()) status.print("ROS 2: " + bridge->problem());
  view.reset();  // it looks at the bridge, and both at what the feed takes down
  bridge.reset();
  feed.finish();
  return outcome;
}

}  // namespace palpate::app
