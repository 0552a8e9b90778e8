// Times simulated frames: rate, jitter, drops, repeats and jumps of the stamp.
#include "sim/simulated_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "base/numbers.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// s; a clock other than the host's may jump at any time (judgement)
constexpr double kLongestNap = 1e-3;
constexpr std::uint64_t kJitterStream = 0xa0761d6478bd642fu;
constexpr std::uint64_t kDropStream = 0xe7037ed1a0b428dbu;
constexpr std::uint64_t kRepeatStream = 0x8ebc6af09c88c6e3u;
constexpr std::uint64_t kJumpAt = 100;  // frame of the jump, if frames have no end (judgement)

// Draws a uniform number in [0, 1) for each frame.
double draw(std::uint64_t seed, std::uint64_t frame) {
  return Random(Random(seed).bits() + frame).uniform();
}

void demand(bool right, const char* what, double value) {
  if (!right) {
    throw Error(fmt::format(
        "a simulated camera cannot have {} {:g}; see the limits in docs/simulated_cameras.md", what,
        value));
  }
}

void check(const SimulatedCameraOptions& options) {
  demand(options.rate > 0 && options.rate <= 1e4, "a rate (Hz) of", options.rate);
  demand(std::isfinite(options.phase), "a phase (s) of", options.phase);
  demand(options.jitter >= 0 && 2 * options.jitter * options.rate < 1, "a jitter (s) of",
         options.jitter);
  demand(options.dropped >= 0 && options.dropped < 1, "a share of dropped frames of",
         options.dropped);
  demand(options.repeated >= 0 && options.repeated < 1, "a share of repeated frames of",
         options.repeated);
  demand(options.jump >= 0 && options.jump <= 3600, "a jump (s) of", options.jump);
  demand(options.frames >= 0, "a number of frames of", options.frames);
  demand(options.loop >= 0, "a loop of frames of", options.loop);
}

// May its pictures be the same bit for bit?
bool repeats(const SimulatedCameraOptions& options) {
  return options.noise.kind == NoiseKind::none || options.loop == 1;
}

Eigen::Vector3d direction(Random& random) {
  Eigen::Vector3d drawn;
  for (const int axis : {2, 1, 0}) drawn[axis] = random.normal();  // one order on every compiler
  return drawn.normalized();
}

}  // namespace

SimulatedCamera::SimulatedCamera(SimulatedScene scene, const SimulatedCameraOptions& options)
    : scene_(std::move(scene)),
      options_(options),
      info_{options.name, options.rate, options.clock != nullptr, repeats(options)},
      renderer_(options.camera),
      noise_(options.noise) {
  check(options);
  for (int i = 0; i < options.loop; ++i) {
    loop_.emplace_back();
    make_depth(static_cast<std::uint64_t>(i), loop_.back());
  }
  const double opened = options.clock ? options.clock->now() : 0;
  start_ = options.start.value_or(opened);
  if (options.clock) {
    first_ = next_ = static_cast<std::uint64_t>(
        std::max(0.0, std::ceil((opened - start_ - options.phase) * options.rate)));
  }
}

void SimulatedCamera::begin(double start) {
  if (options_.clock) return;
  start_ = start;
  first_ = next_ = 0;
}

Eigen::Isometry3d SimulatedCamera::true_pose(double t) const {
  return moved(options_.T_world_camera, options_.motion, t);
}

double SimulatedCamera::stamp_of(std::uint64_t frame) const {
  const double jitter =
      options_.jitter * (2 * draw(options_.noise.seed ^ kJitterStream, frame) - 1);
  return start_ + options_.phase + static_cast<double>(frame) / options_.rate + jitter;
}

bool SimulatedCamera::arrives(std::uint64_t frame) const {
  return options_.dropped == 0 ||
         draw(options_.noise.seed ^ kDropStream, frame) >= options_.dropped;
}

// The frame whose depths this one shows: itself, or one before it that arrived.
std::uint64_t SimulatedCamera::shown_in(std::uint64_t frame) const {
  while (
      frame > first_ && options_.repeated > 0 &&
      (!arrives(frame) || draw(options_.noise.seed ^ kRepeatStream, frame) < options_.repeated)) {
    --frame;
  }
  return frame;
}

DepthCamera::Status SimulatedCamera::read(DepthFrame& frame, double timeout) {
  if (options_.clock && !wait_for_frame(timeout)) return DepthCamera::Status::waiting;
  while (!arrives(next_)) ++next_;
  if (options_.frames > 0 && next_ - first_ >= static_cast<std::uint64_t>(options_.frames)) {
    return DepthCamera::Status::ended;
  }
  fill(next_++, frame);
  return DepthCamera::Status::frame;
}

// Waits until the next frame has been taken, and goes on to the newest one.
bool SimulatedCamera::wait_for_frame(double timeout) {
  const Clock& clock = *options_.clock;
  const double began = clock.now();
  const double passed = std::floor((began - start_ - options_.phase) * options_.rate) - 1;
  if (passed > static_cast<double>(next_)) next_ = static_cast<std::uint64_t>(passed);
  while (!arrives(next_) || (arrives(next_ + 1) && stamp_of(next_ + 1) <= began)) ++next_;
  const double until = stamp_of(next_);
  for (double now = began; now < until; now = clock.now()) {
    const double left = std::min(until, began + timeout) - now;
    if (left <= 0) return false;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, kLongestNap)));
  }
  return true;
}

void SimulatedCamera::make_depth(std::uint64_t number, std::vector<float>& depth) {
  const double t = stamp_of(number) - start_;
  renderer_.render(solids_at(scene_, t), true_pose(t), exact_);
  depth = exact_;
  noise_.apply(options_.camera.width, options_.camera.height, number, depth);
}

void SimulatedCamera::fill(std::uint64_t number, DepthFrame& frame) {
  frame.camera = options_.camera;
  frame.stamp = stamp_of(number);
  frame.T_world_sensor.reset();
  if (options_.report_pose) {
    frame.T_world_sensor = true_pose(frame.stamp - start_) * options_.T_camera_reported;
  }
  const auto half = static_cast<std::uint64_t>(options_.frames / 2);
  if (number - first_ >= (half > 0 ? half : kJumpAt)) frame.stamp += options_.jump;
  const std::uint64_t shown = shown_in(number);
  frame.colors.clear();
  if (loop_.empty()) {
    make_depth(shown, frame.depth);
  } else {
    frame.depth = loop_[shown % loop_.size()];
  }
}

Eigen::Isometry3d calibration_error(double meters, double radians, std::uint64_t seed) {
  Random random(seed);
  Eigen::Isometry3d error = Eigen::Isometry3d::Identity();
  error.translation() = meters * direction(random);
  error.linear() = Eigen::AngleAxisd(radians, direction(random)).toRotationMatrix();
  return error;
}

}  // namespace palpate
