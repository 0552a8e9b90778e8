// Hands whose device another node of ROS 2 owns: it tells poses and takes forces, over DDS.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <thread>

#include "device/drivers.hpp"
#include "device/ros_link.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr double kDiscovery = 3;        // s until a node that is there is heard
constexpr double kMeasuring = 0.5;      // s of poses from which rate and delay are told
constexpr double kSilence = 0.02;       // s without a pose: the node is gone, or hangs
constexpr double kOldest = 1;           // s; a stamp further off is of another clock
constexpr double kClockError = 5e-4;    // s; clocks of one machine, read one after the other
constexpr double kVelocitySpan = 0.01;  // s over which positions give a velocity

// What 19 of 20 stay below.
double most_of(std::vector<double> values) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

double milliseconds(const std::string& text) {
  double value = -1;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc{} && stop == end && value >= 0 && value <= 1000) return value;
  throw Error(
      fmt::format("device ros: delay={} is not a number of milliseconds from 0 to 1000", text));
}

class RosDriver final : public DeviceDriver {
 public:
  RosDriver(const DeviceName& name, const Clock& clock)
      : link_(dds::environment_options()), clock_(clock) {
    check_options(name, {"ns", "pose", "wrench", "twist", "joy", "profile", "delay"});
    set_up(link_, name);
    info_ = info_of(device_profile(name.option("profile", "unknown")), "ros:" + name.device);
    connect();
    measure(name);
  }

  ~RosDriver() override { link_.write(Vector3d::Zero()); }
  RosDriver(const RosDriver&) = delete;
  RosDriver& operator=(const RosDriver&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Vector3d& force) override;

 private:
  void connect();
  void measure(const DeviceName& name);
  void check_clocks(const std::vector<double>& ages) const;
  bool take();
  [[nodiscard]] std::optional<double> age() const;
  void estimate_velocity(double now);
  [[nodiscard]] DeviceState ours() const;

  RosLink link_;
  const Clock& clock_;
  DeviceInfo info_;
  RosReading told_;
  Vector3d from_ = Vector3d::Zero();  // a position from which the velocity is told, and its time
  double from_time_ = 0;
};

void RosDriver::connect() {
  const double end = clock_.now() + kDiscovery;
  while (!link_.pose->connected() || !link_.listened()) {
    if (clock_.now() > end) {
      const bool silent = !link_.pose->connected();
      throw Error(fmt::format(
          "{}: nobody {} {}; start its node, or see 'palpate ros' for what is there", info_.name,
          silent ? "publishes" : "takes forces on", silent ? link_.pose_topic : link_.force_topic));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

// How often poses come, and how long it takes from a pose's stamp until its force is at the node.
void RosDriver::measure(const DeviceName& name) {
  std::vector<double> arrivals;
  std::vector<double> ages;
  const double begin = clock_.now();
  while (clock_.now() < begin + kMeasuring) {
    if (!link_.pose->wait(0.05) || !take()) continue;
    arrivals.push_back(clock_.now());
    if (const auto aged = age()) ages.push_back(*aged);
  }
  if (arrivals.size() < 10) {
    throw Error(fmt::format("{}: {} poses came on {} in {} s; a hand needs hundreds", info_.name,
                            arrivals.size(), link_.pose_topic, kMeasuring));
  }
  info_.rate = (static_cast<double>(arrivals.size()) - 1) / (arrivals.back() - arrivals.front());
  if (const std::string told = name.option("delay"); !told.empty()) {
    info_.delay = milliseconds(told) / 1e3;
  } else if (!ages.empty()) {
    check_clocks(ages);
    // How long forces take nobody tells: no less than the quickest pose.
    info_.delay = most_of(ages) + std::max(0.0, std::ranges::min(ages));
  }
}

// Of poses that come before they were measured nobody knows how old they are.
void RosDriver::check_clocks(const std::vector<double>& ages) const {
  const double youngest = *std::ranges::min_element(ages);
  if (youngest >= -kClockError) return;
  throw Error(fmt::format(
      "{}: stamps on {} are {:.1f} ms in the future, so the delay, and with it the stiffness that "
      "is "
      "stable, cannot be told; synchronise the two machines' clocks (chrony), or give delay=MS",
      info_.name, link_.pose_topic, -1e3 * youngest));
}

// Everything that waits; false: no pose does.
bool RosDriver::take() {
  for (const auto& other : link_.others) other->take(told_);
  return link_.pose->take(told_);
}

std::optional<double> RosDriver::age() const {
  if (!told_.stamp) return {};
  const double age = message::system_now() - *told_.stamp;
  if (std::abs(age) > kOldest) return {};
  return age;
}

DeviceState RosDriver::exchange(const Vector3d& force) {
  const double begin = clock_.now();
  if (!link_.write(link_.axes.to_ours.transpose() * force)) {
    throw Error(
        fmt::format("{}: the force could not be sent on {}", info_.name, link_.force_topic));
  }
  while (!take()) {
    const double left = begin + kSilence - clock_.now();
    if (left <= 0) {
      throw Error(fmt::format("{}: no pose on {} for {:.0f} ms", info_.name, link_.pose_topic,
                              1e3 * kSilence));
    }
    link_.pose->wait(left);
  }
  if (!link_.listened())
    throw Error(fmt::format("{}: nobody takes forces on {}", info_.name, link_.force_topic));
  const std::optional<double> aged = age();
  if (info_.delay && told_.stamp && (!aged || *aged > *info_.delay + kSilence)) {
    throw Error(
        fmt::format("{}: a pose with a stamp {:.3g} s from now, when {:.3g} ms were usual; is the "
                    "network slow, or was a clock set?",
                    info_.name, message::system_now() - *told_.stamp, 1e3 * *info_.delay));
  }
  if (!told_.has_velocity) estimate_velocity(clock_.now());
  return ours();
}

void RosDriver::estimate_velocity(double now) {
  const double span = now - from_time_;
  if (span < kVelocitySpan) return;
  told_.state.velocity =
      span < 4 * kVelocitySpan ? Vector3d((told_.state.position - from_) / span) : Vector3d::Zero();
  from_ = told_.state.position;
  from_time_ = now;
}

DeviceState RosDriver::ours() const {
  DeviceState state = told_.state;
  const RosAxes& axes = link_.axes;
  state.position = axes.unit * (axes.to_ours * state.position);
  state.velocity = axes.unit * (axes.to_ours * state.velocity);
  state.orientation = Eigen::Quaterniond(axes.to_ours) * state.orientation;
  return state;
}

}  // namespace

DriverInfo list_ros() {
  return {.name = "ros",
          .description = "devices that a node of ROS 2 owns: ros:PRESET (docs/ros2.md)",
          .missing = {},
          .devices = {}};
}

std::unique_ptr<DeviceDriver> open_ros(const DeviceName& name, const Clock& clock) {
  return std::make_unique<RosDriver>(name, clock);
}

}  // namespace palpate::device
