// Converts raw Kinect disparities and device times, and keeps live cameras open.
#include "sensor/live_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::sensor {
namespace {

constexpr double kReference = 1.2;   // distance of the reference plane, m
constexpr double kPixel = 1.042e-3;  // a pixel of the sensor (1280 x 960) on that plane, m
constexpr double kBaseline = 0.075;  // from projector to camera, m
constexpr double kShift = 200.375;   // of the reference plane's raw value, pixels of the sensor
constexpr double kFarthest = 15;     // m; steps are above half a metre there
// Raw value of a pixel without depth: 2^11 - 1 (libfreenect's FREENECT_DEPTH_RAW_NO_VALUE)
constexpr std::uint16_t kNoValue = 2047;

}  // namespace

Pinhole kinect_pinhole(int width, int height) {
  const double focal = kReference / kPixel * width / 1280;
  return {.fx = focal, .fy = focal, .cx = width / 2.0, .cy = height / 2.0};
}

float kinect_metres(std::uint16_t raw) {
  if (raw >= kNoValue) return 0;
  // Similar triangles: where a ray of the projector meets the reference plane, seen from here.
  const double shift = (raw / 4.0 - kShift) * kPixel;
  if (shift >= kBaseline) return 0;
  const double z = kReference * kBaseline / (kBaseline - shift);
  return z > kFarthest ? 0.0F : static_cast<float>(z);
}

namespace {

constexpr double kDrift = 2e-4;  // s per s; crystals differ by less (judgement)
constexpr double kJump = 1;      // s; a device whose clock jumped so far was restarted (judgement)

}  // namespace

double HostStamps::host(double device, double arrival) {
  const double found = arrival - device;
  if (!difference_ || device <= device_ || std::abs(found - *difference_) > kJump) {
    difference_ = found;
  } else {
    difference_ = std::min(found, *difference_ + kDrift * std::max(0.0, arrival - arrival_));
  }
  arrival_ = arrival;
  device_ = device;
  return device + *difference_;
}

namespace {

// Devices need a second or two after they are opened; a loose plug is silent for ever.
constexpr double kLongSilence = 3;  // s (judgement)

}  // namespace

LiveCamera::LiveCamera(CameraInfo info, Connect connect, std::string silence, const Clock* clock,
                       Lost lost)
    : info_(std::move(info)),
      connect_(std::move(connect)),
      silence_(std::move(silence)),
      clock_(clock),
      lost_(lost) {
  this->connect();
}

void LiveCamera::connect() {
  connection_ = connect_();
  stamps_ = {};
  received_ = (clock_ != nullptr ? *clock_ : host_).now();
}

void LiveCamera::begin(double start) {
  if (lost_ != Lost::ended) return;
  connection_.reset();  // two at once may not be had
  connect();
  stamp_ = start;
  device_time_.reset();
}

DepthCamera::Status LiveCamera::read(DepthFrame& frame, double timeout) {
  reason_.clear();
  if (!connection_ && lost_ == Lost::ended) return DepthCamera::Status::ended;
  try {
    if (!connection_) connect();
    return fetch(frame, timeout);
  } catch (const Error& error) {
    reason_ = error.what();
    connection_.reset();
    return DepthCamera::Status::failed;
  }
}

DepthCamera::Status LiveCamera::fetch(DepthFrame& frame, double timeout) {
  double device_time = 0;
  const DepthCamera::Status status = connection_->fetch(frame, device_time, timeout);
  const double now = (clock_ != nullptr ? *clock_ : host_).now();
  if (status == DepthCamera::Status::waiting) return silent(now);
  received_ = now;
  if (status == DepthCamera::Status::damaged) reason_ = connection_->damage();
  if (status == DepthCamera::Status::frame) {
    frame.stamp = stamp_of(device_time, now);
    frame.T_world_sensor.reset();
  }
  return status;
}

DepthCamera::Status LiveCamera::silent(double now) {
  if (now - received_ <= kLongSilence) return DepthCamera::Status::waiting;
  reason_ =
      fmt::format("{}: open, but silent for {:.3g} s. {}", info_.name, now - received_, silence_);
  received_ = now;
  // A recording may hold long pauses; a device is better opened again.
  if (lost_ == Lost::opened_again) connection_.reset();
  return DepthCamera::Status::failed;
}

double LiveCamera::stamp_of(double device_time, double now) {
  if (info_.paces) return stamps_.host(device_time, now);
  if (device_time_) {
    stamp_ += device_time > *device_time_ ? device_time - *device_time_ : 1 / info_.rate;
  }
  device_time_ = device_time;
  return stamp_;
}

}  // namespace palpate::sensor
