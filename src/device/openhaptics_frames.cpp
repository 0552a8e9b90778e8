#include "device/openhaptics_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "device/openhaptics_codes.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr double kMillimetre = 1e-3;  // m

// The maker's x is to the right, y up, z towards the operator.
Vector3d from_hd(const Vector3d& v) {
  return {v.x(), -v.z(), v.y()};
}
Vector3d to_hd(const Vector3d& v) {
  return {v.x(), v.z(), -v.y()};
}

std::chrono::steady_clock::time_point deadline_in(double seconds) {
  using std::chrono::steady_clock;
  return steady_clock::now() +
         std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(seconds));
}

void copy_words(const char* words, std::array<char, 64>& to) {
  if (words != nullptr) std::strncpy(to.data(), words, to.size() - 1);
}

// One of those that the device knows; never the reset of encoders, which takes this pose for
// another.
unsigned calibration_style(int known) {
  return (known & hd::kAutomatic) != 0 ? hd::kAutomatic : hd::kInkwell;
}

double known_or_zero(double number) {
  return std::isfinite(number) && number > 0 ? number : 0;
}

}  // namespace

void OpenHapticsFrames::ask(const Vector3d& force) noexcept {
  wanted_.set({force, clock_.now(), ++asked_});
}

std::optional<OpenHapticsFrames::Answer> OpenHapticsFrames::answer(double patience) noexcept {
  std::uint64_t turn = common_.gate.turn();
  auto end = deadline_in(patience);
  while (true) {
    const Answer newest = answers_.get();
    if (newest.number == asked_) return newest;
    if (std::chrono::steady_clock::now() >= end) {
      const std::uint64_t seen = std::exchange(turn, common_.gate.turn());
      if (seen == turn && !FrameGate::is_closed(turn)) return std::nullopt;
      end = deadline_in(patience);  // frames may have stood still
    }
    (void)wakeup_.wait_until(end);
  }
}

void OpenHapticsFrames::end(double patience) noexcept {
  leaving_ = true;
  if (is_over_within(patience) || lane_->give_up()) return;
  if (!is_over_within(patience)) lane_->end();
}

bool OpenHapticsFrames::is_over_within(double patience) noexcept {
  const auto end = deadline_in(patience);
  while (!lane_->is_over() && std::chrono::steady_clock::now() < end) {
    (void)wakeup_.wait_until(end);
  }
  return lane_->is_over();
}

unsigned OpenHapticsFrames::call(void* frames) noexcept {
  auto* const self = static_cast<std::shared_ptr<OpenHapticsFrames>*>(frames);
  const unsigned code = (*self)->tick();
  if (code == hd::kDone) delete self;
  return code;
}

unsigned OpenHapticsFrames::tick() noexcept {
  if (lane_->stands(common_.gate.turn())) return hd::kContinue;
  if (!lane_->enter()) return hd::kDone;
  // Whoever closes the gate after this look waits for the next tick to stand still.
  const std::uint64_t turn = common_.gate.turn();
  if (leaving_) {
    leave();
    return hd::kDone;
  }
  if (FrameGate::is_closed(turn)) {
    rest();
    lane_->stand(turn);
  } else {
    frame();
  }
  lane_->leave();
  return hd::kContinue;
}

void OpenHapticsFrames::frame() noexcept {
  if (!begin()) return;
  if (frames_ == 0) {
    keep_failure();
    learn();
  }
  if (calibrate_.exchange(false)) {
    library_.update_calibration(calibration_style(facts_.calibration_styles));
  }
  newest_.calibration = library_.check_calibration();
  const LinkReading reading = read();
  keep_failure();  // before there is a force
  if (const std::optional<Wanted> wanted = wanted_.look()) taken_ = *wanted;
  library_.set_numbers(hd::kCurrentForce, to_hd(permitted(reading)).eval().data());
  library_.end_frame(device_);
  keep_failure();
  ++frames_;
  tell(reading);
}

// A frame without a force.
void OpenHapticsFrames::rest() noexcept {
  if (!begin()) return;
  const Vector3d zero = Vector3d::Zero();
  library_.set_numbers(hd::kCurrentForce, zero.data());
  library_.end_frame(device_);
  keep_failure();
}

// False: it hung, and was given up: the device may be closed by now.
bool OpenHapticsFrames::begin() noexcept {
  library_.make_current(device_);
  if (frames_ == 0) library_.enable(hd::kForceOutput);
  library_.begin_frame(device_);
  return !lane_->is_over();
}

void OpenHapticsFrames::learn() noexcept {
  copy_words(library_.get_name(hd::kModel), facts_.model);
  copy_words(library_.get_name(hd::kSerialNumber), facts_.serial_number);
  library_.get_numbers(hd::kContinuousForce, &facts_.continuous_force);
  library_.get_numbers(hd::kMaximumStiffness, &facts_.maximum_stiffness);
  library_.get_integers(hd::kCalibrationStyle, &facts_.calibration_styles);
  std::array<double, 6> temperatures{};  // of three motors or six
  library_.get_numbers(hd::kMotorTemperature, temperatures.data());
  facts_.temperature = std::ranges::max(temperatures);
  facts_.continuous_force = known_or_zero(facts_.continuous_force);
  facts_.maximum_stiffness = known_or_zero(facts_.maximum_stiffness / kMillimetre);
  (void)common_.errors.take(library_, device_);  // older libraries do not know all of this
}

LinkReading OpenHapticsFrames::read() const noexcept {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  int buttons = 0;
  library_.get_numbers(hd::kCurrentPosition, position.data());
  library_.get_numbers(hd::kCurrentVelocity, velocity.data());
  library_.get_integers(hd::kCurrentButtons, &buttons);
  return {kMillimetre * from_hd(position), kMillimetre * from_hd(velocity),
          static_cast<std::uint32_t>(buttons)};
}

Vector3d OpenHapticsFrames::permitted(const LinkReading& reading) const noexcept {
  const bool heard = clock_.now() - taken_.time <= kSilence;
  const bool known = reading.position.allFinite() && reading.velocity.allFinite();
  const bool calibrated = newest_.calibration != hd::kNeedsHand;
  const bool good = newest_.failure == hd::kSuccess && calibrated && !leaving_;
  return heard && known && good ? taken_.force : Vector3d::Zero();
}

void OpenHapticsFrames::keep_failure() noexcept {
  const unsigned code = common_.errors.take(library_, device_);
  if (newest_.failure == hd::kSuccess) newest_.failure = code;
}

void OpenHapticsFrames::tell(const LinkReading& reading) noexcept {
  const bool asked = newest_.number != taken_.number;
  newest_.reading = reading;
  newest_.number = taken_.number;
  answers_.set(newest_);
  if (asked) wakeup_.post();
}

void OpenHapticsFrames::leave() noexcept {
  rest();
  if (!lane_->is_over()) library_.disable(hd::kForceOutput);
  lane_->end();
  wakeup_.post();
}

}  // namespace palpate::device
