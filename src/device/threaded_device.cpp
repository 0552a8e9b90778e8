// Runs a device driver on its own thread and checks what the driver reports.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "base/latest.hpp"
#include "base/requirement.hpp"
#include "geometry/wrench.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate {
namespace {

constexpr double kStaleExchanges = 2.5;  // exchanges without a reading: silent (judgement)
// No hand exceeds these: m from a device's origin, m/s (judgement).
constexpr double kFarthestHand = 5;
constexpr double kFastestHand = 20;
// Largest move between readings: m/s, plus the steps of coarse encoders, m (judgement).
constexpr double kFastestMove = 10;
constexpr double kCoarsestStep = 0.5e-3;
// The same of turns: rad/s, and rad, of a wrist that is read ten times more rarely (judgement).
constexpr double kFastestTurn = 100;
constexpr double kCoarsestTurn = 0.5;

constexpr const char* kDistrust =
    "so it got no force. It will be reopened; if that does not help, switch it off and on, and "
    "calibrate it";

ThreadedDeviceOptions checked(ThreadedDeviceOptions options) {
  const Requirement require{"threaded device"};
  require.positive("state_timeout (s)", options.state_timeout, "give a time above 0");
  require.positive("force_timeout (s)", options.force_timeout, "give a time above 0");
  require.positive("retry_interval (s)", options.retry_interval, "give a time above 0");
  return options;
}

// Delay: the hardware's (unknown: one exchange), plus one each that position and force may wait.
DeviceInfo info_of(const DeviceDriver& driver) {
  DeviceInfo info = driver.info();
  info.keeps_time = false;
  info.delay = info.delay.value_or(1 / info.rate) + 2 / info.rate;
  return info;
}

// False for NaN, too.
bool is_possible(const DeviceState& reading) {
  return reading.position.norm() <= kFarthestHand && reading.velocity.norm() <= kFastestHand;
}

void check(const DeviceState& reading, const DeviceInfo& info) {
  const bool tool = reading.orientation.coeffs().allFinite() &&
                    reading.angular_velocity.allFinite() && std::isfinite(reading.gripper);
  if (tool && is_possible(reading)) return;
  throw Error(
      fmt::format("{}: reported a position that is not a number or impossible for a hand, {}",
                  info.name, kDistrust));
}

// Ratio of delays; a device that became slower would get forces too stiff for it (judgement).
constexpr double kSlower = 1.25;

// Why the reopened device cannot replace the lost one; empty if it can.
std::string objection_to(const DeviceInfo& found, const DeviceInfo& expected) {
  if (found.name != expected.name) {
    return fmt::format("found {} instead of {}; restart to use it", found.name, expected.name);
  }
  if (*found.delay <= kSlower * *expected.delay) return {};
  return fmt::format("{}: slower than when it was opened; restart", found.name);
}

using Connection = std::uint32_t;  // its number, from 1
constexpr Connection kNone = 0;

}  // namespace

struct Reading {
  DeviceState state;  // without status and time
  double begin = 0;   // s, of its exchange
  double end = 0;
  Connection connection = kNone;
};

struct Command {
  Wrench wrench;
  double time = 0;                // s, when it was written
  Connection connection = kNone;  // whose position it answers
};

// Exchanges forces for readings with a driver and reopens it. One thread calls service() or run().
struct Hardware {
  Hardware(ThreadedDevice::Open the_open, WaitingClock& the_clock,
           ThreadedDeviceOptions the_options)
      : open(std::move(the_open)),
        clock(the_clock),
        options(checked(std::move(the_options))),
        driver(open()),
        info(info_of(*driver)) {
    options.state_timeout = std::max(options.state_timeout, kStaleExchanges / info.rate);
  }

  void run(const std::stop_token& stop) noexcept;
  void service() noexcept;
  void exchange() noexcept;
  void check_move_to(const Reading& reading) const;
  void reopen() noexcept;
  void lose(const char* why) noexcept;
  [[nodiscard]] Wrench applicable(double now) const noexcept;

  ThreadedDevice::Open open;
  WaitingClock& clock;
  ThreadedDeviceOptions options;
  std::unique_ptr<DeviceDriver> driver;  // null: lost
  DeviceInfo info;                       // does not change; the servo's thread reads it, too
  Reading newest;
  Connection connection = 1;
  double retry_at = 0;  // s

  // Shared with the servo's thread.
  Latest<Reading> readings;
  Latest<Command> commands;
  mutable std::mutex loss_mutex;  // the servo's thread never takes it
  std::string loss;               // why the hardware is lost; empty: it is there
};

struct ThreadedDevice::Inside {
  Inside(Open open, WaitingClock& clock, ThreadedDeviceOptions options)
      : hardware(std::move(open), clock, std::move(options)) {}

  Hardware hardware;
  DeviceState state{.status = DeviceState::Status::silent};  // the servo's, as the next two
  Reading seen;
  Connection located = kNone;  // the connection whose position the last step reported
  std::atomic<DeviceState::Status> status{DeviceState::Status::silent};  // any thread's
  std::jthread thread;  // last: it uses the hardware
};

ThreadedDevice::ThreadedDevice(Open open, WaitingClock& clock, ThreadedDeviceOptions options)
    : inside_(std::make_unique<Inside>(std::move(open), clock, std::move(options))) {
  Hardware& hardware = inside_->hardware;
  if (!hardware.options.threaded) return;
  try {
    inside_->thread = std::jthread([&](const std::stop_token& stop) { hardware.run(stop); });
  } catch (const std::system_error& error) {
    throw Error(fmt::format("{}: cannot start a thread ({}); close other programs",
                            hardware.info.name, error.what()));
  }
}

// The thread ends first, then the driver: zero force.
ThreadedDevice::~ThreadedDevice() = default;

const DeviceInfo& ThreadedDevice::info() const noexcept {
  return inside_->hardware.info;
}

void ThreadedDevice::service() noexcept {
  inside_->hardware.service();
}

void Hardware::run(const std::stop_token& stop) noexcept {
  if (options.begin) options.begin();
  const double period = 1 / info.rate;
  double due = clock.now();
  while (!stop.stop_requested()) {
    service();
    due = std::max(due + period, clock.now());
    clock.wait_until(due);
  }
}

void Hardware::service() noexcept {
  if (driver) {
    exchange();
  } else if (clock.now() >= retry_at) {
    reopen();
  }
}

void Hardware::exchange() noexcept {
  try {
    const double begin = clock.now();
    const DeviceState reported = driver->exchange_wrench(applicable(begin));
    check(reported, info);
    const Reading reading{reported, begin, clock.now(), connection};
    check_move_to(reading);
    newest = reading;
    readings.set(newest);
  } catch (const std::exception& error) {
    lose(error.what());
  }
}

// A position may be sampled at any moment of its exchange. The longer of the times between two
// beginnings and two ends is at least half that between the samples: however late either came, a
// hand slower than half of kFastestMove is not refused.
void Hardware::check_move_to(const Reading& reading) const {
  if (newest.connection != reading.connection) return;
  const double time =
      std::max({reading.begin - newest.begin, reading.end - newest.end, 1 / info.rate});
  const double move = (reading.state.position - newest.state.position).norm();
  const double turn = reading.state.orientation.angularDistance(newest.state.orientation);
  const bool far = move > kFastestMove * time + kCoarsestStep;
  if (!far && turn <= kFastestTurn * time + kCoarsestTurn) return;
  throw Error(
      fmt::format("{}: its {} jumped by {:.1f} {} in {:.2f} ms, faster than a hand can move, {}",
                  info.name, far ? "position" : "orientation", far ? 1e3 * move : turn,
                  far ? "mm" : "rad", 1e3 * time, kDistrust));
}

Wrench Hardware::applicable(double now) const noexcept {
  const Command command = commands.get();
  if (command.connection != connection || now - command.time > options.force_timeout) return {};
  return shortened(command.wrench, info.maximum_force, info.maximum_torque, info.maximum_grip);
}

void Hardware::lose(const char* why) noexcept {
  newest.connection = kNone;
  readings.set(newest);
  driver.reset();  // zero force, before anything that takes a lock or memory
  ++connection;
  retry_at = clock.now() + options.retry_interval;
  const std::lock_guard lock(loss_mutex);
  loss = why;
}

// Keeps the reason of the loss: that the hardware is not back yet is no news.
void Hardware::reopen() noexcept {
  try {
    std::unique_ptr<DeviceDriver> found = open();
    const std::string objection = objection_to(info_of(*found), info);
    const std::lock_guard lock(loss_mutex);
    loss = objection;
    if (objection.empty()) driver = std::move(found);
  } catch (const std::exception&) {  // not back yet
  }
  if (!driver) retry_at = clock.now() + options.retry_interval;
}

DeviceState ThreadedDevice::read() noexcept {
  Inside& in = *inside_;
  if (in.state.status == DeviceState::Status::failed) return in.state;
  const double now = in.hardware.clock.now();
  if (const std::optional<Reading> reading = in.hardware.readings.look()) in.seen = *reading;
  const bool fresh =
      in.seen.connection != kNone && now - in.seen.end <= in.hardware.options.state_timeout;
  if (fresh) {
    in.state = in.seen.state;
    const bool located = in.located == in.seen.connection;
    in.state.time = in.seen.end;
    in.state.status = located ? DeviceState::Status::ok : DeviceState::Status::silent;
    in.located = in.seen.connection;
  } else {
    in.state.status = DeviceState::Status::silent;
    in.state.velocity.setZero();
    in.state.angular_velocity.setZero();
    in.state.buttons = 0;
    in.located = kNone;
  }
  in.status.store(in.state.status);
  return in.state;
}

void ThreadedDevice::write_wrench(const Wrench& wrench) noexcept {
  Inside& in = *inside_;
  if (in.state.status == DeviceState::Status::failed) return;
  if (is_finite(wrench)) {
    const bool felt = in.state.status == DeviceState::Status::ok;
    in.hardware.commands.set({wrench, in.hardware.clock.now(), felt ? in.located : kNone});
    return;
  }
  in.hardware.commands.set({});
  in.state.status = DeviceState::Status::failed;
  in.status.store(in.state.status);
}

std::string ThreadedDevice::reason() const {
  const Inside& in = *inside_;
  const DeviceState::Status status = in.status.load();
  if (status == DeviceState::Status::failed) {
    return "a written force was not finite; find the error in the code that computed it";
  }
  if (status == DeviceState::Status::ok) return {};
  const std::lock_guard lock(in.hardware.loss_mutex);
  if (!in.hardware.loss.empty()) return in.hardware.loss;
  return fmt::format(
      "{}: does not answer; if this persists, check its cable and power, and what else keeps the "
      "computer busy",
      in.hardware.info.name);
}

}  // namespace palpate
