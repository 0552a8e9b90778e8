#include "palpate/device/linked_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/requirement.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kStaleExchanges = 2.5;

// What no hand does: m from a device's origin, m/s.
constexpr double kFarthestHand = 5;
constexpr double kFastestHand = 20;

// From one place to the next: m/s, and what the steps of coarse encoders add, m.
constexpr double kFastestWay = 10;
constexpr double kCoarsestStep = 0.5e-3;

constexpr const char* kDistrust =
    "so it got no force. It is opened again; if that does not help, switch it off and on, and "
    "calibrate it";

LinkedDeviceOptions checked(LinkedDeviceOptions options) {
  const Requirement require{"linked device"};
  require.positive("stale (s)", options.stale, "give a time above 0");
  require.positive("deaf (s)", options.deaf, "give a time above 0");
  require.positive("retry (s)", options.retry, "give a time above 0");
  return options;
}

// A place waits for the servo, and its force for the next exchange: up to two exchanges more than
// the hardware's own delay, which counts as one where it is not known.
DeviceInfo info_of(const DeviceLink& link) {
  DeviceInfo info = link.info();
  info.keeps_time = false;
  info.delay = info.delay.value_or(1 / info.rate) + 2 / info.rate;
  return info;
}

// False for what is not a number, too.
bool is_a_hands(const LinkReading& reading) {
  return reading.position.norm() <= kFarthestHand && reading.velocity.norm() <= kFastestHand;
}

void check(const LinkReading& reading, const DeviceInfo& info) {
  const bool tool = reading.orientation.coeffs().allFinite() && std::isfinite(reading.gripper);
  if (tool && is_a_hands(reading)) return;
  throw Error(
      fmt::format("{}: tells a place that is no number, or no hand's, {}", info.name, kDistrust));
}

std::string in_its_place(const std::string& there, const std::string& instead_of) {
  return fmt::format("{} is there now instead of {}; start again to use it", there, instead_of);
}

}  // namespace

LinkedDevice::LinkedDevice(Open open, WaitingClock& clock, LinkedDeviceOptions options)
    : open_(std::move(open)),
      clock_(clock),
      options_(checked(std::move(options))),
      link_(open_()),
      info_(info_of(*link_)) {
  options_.stale = std::max(options_.stale, kStaleExchanges / info_.rate);
  if (!options_.threaded) return;
  try {
    thread_ = std::jthread([this](const std::stop_token& stop) {
      if (options_.begin) options_.begin();
      run(stop);
    });
  } catch (const std::system_error& error) {
    throw Error(fmt::format("{}: the system gives no thread ({}); end other programs", info_.name,
                            error.what()));
  }
}

LinkedDevice::~LinkedDevice() {
  thread_ = {};  // asks it to end, and waits; then the link goes: zero force
}

void LinkedDevice::run(const std::stop_token& stop) noexcept {
  const double period = 1 / info_.rate;
  double due = clock_.now();
  while (!stop.stop_requested()) {
    turn();
    due = std::max(due + period, clock_.now());
    clock_.wait_until(due);
  }
}

void LinkedDevice::turn() noexcept {
  if (link_) {
    exchange();
  } else if (clock_.now() >= retry_at_) {
    open_again();
  }
}

void LinkedDevice::exchange() noexcept {
  try {
    const double asked = clock_.now();
    const LinkReading reading = link_->exchange(applicable(asked));
    check(reading, info_);
    const Heard heard{reading, asked, clock_.now(), connection_};
    check_way_to(heard);
    newest_ = heard;
    heard_.set(newest_);
  } catch (const std::exception& error) {
    lose(error.what());
  }
}

// A place may be taken at any moment of its exchange. The longer one of the times between two
// beginnings and two ends is at least half of what lies between two places: however late either
// came, no hand is refused that is slower than half of kFastestWay.
void LinkedDevice::check_way_to(const Heard& heard) const {
  if (newest_.connection != heard.connection) return;
  const double time =
      std::max({heard.asked - newest_.asked, heard.time - newest_.time, 1 / info_.rate});
  const double way = (heard.reading.position - newest_.reading.position).norm();
  if (way <= kFastestWay * time + kCoarsestStep) return;
  throw Error(fmt::format("{}: its place leapt by {:.1f} mm in {:.2f} ms, as no hand goes, {}",
                          info_.name, 1e3 * way, 1e3 * time, kDistrust));
}

Vector3d LinkedDevice::applicable(double now) const noexcept {
  const Wanted wanted = wanted_.get();
  if (wanted.connection != connection_ || now - wanted.time > options_.deaf) {
    return Vector3d::Zero();
  }
  const double length = wanted.force.norm();
  const double most = info_.maximum_force;
  return length > most ? Vector3d(most / length * wanted.force) : wanted.force;
}

void LinkedDevice::lose(const char* why) noexcept {
  newest_.connection = kNone;
  heard_.set(newest_);
  link_.reset();  // zero force, before anything that takes a lock or memory
  losses_.fetch_add(1);
  ++connection_;
  retry_at_ = clock_.now() + options_.retry;
  const std::lock_guard lock(words_mutex_);
  words_ = why;
}

// The words stay those of the loss: that it is not back yet is no news.
void LinkedDevice::open_again() noexcept {
  try {
    std::unique_ptr<DeviceLink> link = open_();
    const bool same = link->info().name == info_.name;
    const std::lock_guard lock(words_mutex_);
    words_ = same ? "" : in_its_place(link->info().name, info_.name);
    if (same) link_ = std::move(link);
  } catch (const std::exception&) {  // not back yet
  }
  if (!link_) retry_at_ = clock_.now() + options_.retry;
}

DeviceState LinkedDevice::read() noexcept {
  if (state_.status == DeviceStatus::failed) return state_;
  const double now = clock_.now();
  if (const std::optional<Heard> heard = heard_.look()) seen_ = *heard;
  const bool known = seen_.connection != kNone && now - seen_.time <= options_.stale;
  state_.time = now;
  if (known) {
    const bool placed = placed_ == seen_.connection;
    state_.status = placed ? DeviceStatus::ok : DeviceStatus::silent;
    state_.position = seen_.reading.position;
    state_.velocity = seen_.reading.velocity;
    state_.buttons = seen_.reading.buttons;
    state_.orientation = seen_.reading.orientation;
    state_.gripper = seen_.reading.gripper;
    placed_ = seen_.connection;
  } else {
    state_.status = DeviceStatus::silent;
    state_.velocity.setZero();
    state_.buttons = 0;
    placed_ = kNone;
  }
  status_.store(state_.status);
  return state_;
}

void LinkedDevice::write(const Vector3d& force) noexcept {
  if (state_.status == DeviceStatus::failed) return;
  if (force.allFinite()) {
    const bool felt = state_.status == DeviceStatus::ok;
    wanted_.set({force, clock_.now(), felt ? placed_ : kNone});
    return;
  }
  wanted_.set({});
  state_.status = DeviceStatus::failed;
  status_.store(state_.status);
}

std::string LinkedDevice::reason() const {
  const DeviceStatus status = status_.load();
  if (status == DeviceStatus::failed) {
    return "a force that was written was not finite; look for the fault in what computed it";
  }
  if (status == DeviceStatus::ok) return {};
  const std::lock_guard lock(words_mutex_);
  if (!words_.empty()) return words_;
  return fmt::format(
      "{}: does not answer; if that lasts, look at its cable and its power, and at what else keeps "
      "the computer busy",
      info_.name);
}

}  // namespace palpate
