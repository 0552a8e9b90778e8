// Reads a hand and applies its force in frames of OpenHaptics' scheduler.
#include <algorithm>
#include <array>
#include <cmath>

#include "device/openhaptics_scheduler.hpp"
#include "geometry/rotation.hpp"
#include "geometry/turn.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;
using std::chrono::steady_clock;

constexpr double kMillimetre = 1e-3;        // m; OpenHaptics measures in mm (the maker's)
constexpr double kMillinewtonMetre = 1e-3;  // N m; and torques in mN m
constexpr double kFrameRate = 1000;         // Hz, of its scheduler (the maker's)

// The maker's x is to the right, y up, z towards the operator.
Vector3d from_hd(const Vector3d& v) {
  return {v.x(), -v.z(), v.y()};
}
Vector3d to_hd(const Vector3d& v) {
  return {v.x(), v.z(), -v.y()};
}

// Picks a style that the device supports; never the reset of encoders, which takes the present pose
// for the one that it should be in.
unsigned calibration_style(int supported) {
  return (supported & hd::kAutomatic) != 0 ? hd::kAutomatic : hd::kInkwell;
}

}  // namespace

void OpenHapticsHand::end_frame(const Wrench& wrench) const noexcept {
  library.set_numbers(hd::kCurrentForce, to_hd(wrench.force).eval().data());
  const Vector3d torque = to_hd(wrench.torque / kMillinewtonMetre);
  if (turns) library.set_numbers(hd::kCurrentTorque, torque.data());
  library.end_frame(device);
}

DeviceState OpenHapticsHand::read() const noexcept {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  int buttons = 0;
  library.get_numbers(hd::kCurrentPosition, position.data());
  library.get_numbers(hd::kCurrentVelocity, velocity.data());
  library.get_integers(hd::kCurrentButtons, &buttons);
  DeviceState state;
  state.position = kMillimetre * from_hd(position);
  state.velocity = kMillimetre * from_hd(velocity);
  state.buttons = static_cast<std::uint32_t>(buttons);
  state.orientation = orientation();
  return state;
}

// Tool and base are rotated alike: straight stays straight.
Eigen::Quaterniond OpenHapticsHand::orientation() const noexcept {
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();  // column by column, as theirs
  library.get_numbers(hd::kCurrentTransform, transform.data());
  const Eigen::Matrix3d maker = transform.topLeftCorner<3, 3>();
  Eigen::Matrix3d ours;
  for (int i = 0; i < 3; ++i) ours.col(i) = from_hd(maker * to_hd(Vector3d::Unit(i)));
  if (!is_rotation(ours)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(ours).normalized();
}

double OpenHapticsHand::warmest_motor() const noexcept {
  std::array<double, 6> temperatures{};  // of three motors or six
  library.get_numbers(hd::kMotorTemperature, temperatures.data());
  (void)take_error();  // older libraries do not support it
  return std::ranges::max(temperatures);
}

void OpenHapticsFrames::request(const Wrench& wrench) noexcept {
  wanted_.set({wrench, clock_.now(), ++requested_});
}

std::optional<OpenHapticsFrames::Answer> OpenHapticsFrames::answer(double patience) noexcept {
  TimePoint end = steady_clock::now() + seconds(patience);
  while (true) {
    const Answer newest = answers_.get();
    if (newest.number == requested_) return newest;
    const TimePoint now = steady_clock::now();
    // Time at rest does not count.
    end = std::max(end, std::min(now, runs_since_.load()) + seconds(patience));
    if (now >= end) return std::nullopt;
    wakeup_.wait_until(end);
  }
}

void OpenHapticsFrames::tick() noexcept {
  if (over_) return;
  if (runs_since_.load() != TimePoint::max()) {
    at_rest_ = false;
    frame();
  } else if (!at_rest_) {
    frame_without_force();
    at_rest_ = true;
  }
}

void OpenHapticsFrames::frame() noexcept {
  hand_.begin_frame();
  if (over_) return;  // it may have hung
  if (!newest_.temperature) {
    keep_failure();
    newest_.temperature = hand_.warmest_motor();
  }
  if (const int styles = calibrate_.exchange(0); styles != 0) {
    hand_.library.update_calibration(calibration_style(styles));
  }
  newest_.calibration = hand_.library.check_calibration();
  read();
  keep_failure();  // before there is a force
  if (const std::optional<Wanted> wanted = wanted_.look()) taken_ = *wanted;
  hand_.end_frame(permitted(newest_.state));
  keep_failure();
  const bool is_awaited = newest_.number != taken_.number;
  newest_.number = taken_.number;
  answers_.set(newest_);
  if (is_awaited) wakeup_.post();
}

// The maker's own velocity of turns is in axes that it does not document: a frame is a millisecond.
void OpenHapticsFrames::read() noexcept {
  const Eigen::Quaterniond before = newest_.state.orientation;
  const bool first = newest_.number == 0;
  newest_.state = hand_.read();
  if (first) return;
  newest_.state.angular_velocity = kFrameRate * turn_between(before, newest_.state.orientation);
}

void OpenHapticsFrames::frame_without_force() noexcept {
  hand_.begin_frame();
  if (over_) return;
  hand_.end_frame({});
  keep_failure();
}

Wrench OpenHapticsFrames::permitted(const DeviceState& state) const noexcept {
  const bool recent = clock_.now() - taken_.time <= kForceTimeout;
  const bool finite = state.position.allFinite() && state.velocity.allFinite();
  const bool calibrated = newest_.calibration != hd::kNeedsHand;
  const bool good = newest_.failure == hd::kSuccess && calibrated;
  return recent && finite && good ? taken_.wrench : Wrench();
}

void OpenHapticsFrames::keep_failure() noexcept {
  const unsigned code = hand_.take_error();
  if (newest_.failure == hd::kSuccess) newest_.failure = code;
}

}  // namespace palpate::device
