// Hands whose device another node of ROS 2 owns: it publishes poses and takes forces, over DDS.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <thread>

#include "device/drivers.hpp"
#include "device/ros_link.hpp"
#include "geometry/turn.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;

constexpr double kDiscovery = 3;        // s for a running node to be discovered (judgement)
constexpr double kMeasuring = 0.5;      // s of poses that give rate and delay (judgement)
constexpr double kSilence = 0.02;       // s without a pose: the node is gone, or hangs (judgement)
constexpr double kOldest = 1;           // s; a stamp further off is from another clock (judgement)
constexpr double kClockError = 5e-4;    // s that a good clock's stamp may be ahead (judgement)
constexpr double kVelocitySpan = 0.01;  // s over which positions give a velocity (judgement)

// The 95th percentile.
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
    check_options(
        name, {"ns", "pose", "wrench", "twist", "joy", "profile", "delay", "rotation", "joints"});
    set_up(link_, name);
    const DeviceProfile profile = device_profile(name.option("profile", "unknown"));
    info_ = info_of(profile, "ros:" + name.device);
    // No message tells whether the device has motors at its wrist.
    const bool told = name.options.contains("profile");
    if (link_.takes_torque && told) info_.maximum_torque = profile.maximum_torque.value_or(0);
    connect();
    measure(name);
  }

  ~RosDriver() override { link_.write({}); }
  RosDriver(const RosDriver&) = delete;
  RosDriver& operator=(const RosDriver&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Vector3d& force) override {
    return exchange_wrench({.force = force});
  }
  [[nodiscard]] DeviceState exchange_wrench(const Wrench& wrench) override;

 private:
  void connect();
  void measure(const DeviceName& name);
  void check_clocks(const std::vector<double>& ages) const;
  void check_age() const;
  void check_one_owner() const;
  bool take();
  [[nodiscard]] double age() const { return message::system_now() - *reading_.stamp; }
  void estimate_velocity(double now);
  void estimate_turns(double now);
  [[nodiscard]] DeviceState ours() const;

  RosLink link_;
  const Clock& clock_;
  DeviceInfo info_;
  RosReading reading_;
  std::optional<double> usual_age_;   // of a pose by its stamp, s; unset: there are no stamps
  double velocity_time_ = 0;          // when a velocity came last
  Vector3d from_ = Vector3d::Zero();  // a position from which the velocity is found, and its time
  double from_time_ = 0;
  Eigen::Quaterniond turned_ = Eigen::Quaterniond::Identity();  // the same of turns
  double turned_time_ = 0;
};

void RosDriver::connect() {
  const double end = clock_.now() + kDiscovery;
  while (link_.pose->writers() == 0 || !link_.listened()) {
    if (clock_.now() > end) {
      const bool silent = link_.pose->writers() == 0;
      throw Error(fmt::format("{}: no node {} {}; start it, or see 'palpate ros' for what is there",
                              info_.name, silent ? "publishes" : "subscribes to",
                              silent ? link_.pose_topic : link_.force_topic));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  check_one_owner();
}

void RosDriver::check_one_owner() const {
  const std::size_t writers = link_.pose->writers();
  if (writers < 2) return;
  throw Error(fmt::format("{}: {} nodes publish poses on {}; stop all but the device's", info_.name,
                          writers, link_.pose_topic));
}

// Measures the rate of poses, and the delay from a pose's stamp until its force is at the node.
void RosDriver::measure(const DeviceName& name) {
  std::vector<double> arrivals;
  std::vector<double> ages;
  const double begin = clock_.now();
  while (clock_.now() < begin + kMeasuring) {
    if (!link_.pose->wait(0.05) || !take()) continue;
    arrivals.push_back(clock_.now());
    if (reading_.stamp) ages.push_back(age());
  }
  if (arrivals.size() < 10) {
    throw Error(fmt::format("{}: {} poses came on {} in {} s; a hand needs hundreds", info_.name,
                            arrivals.size(), link_.pose_topic, kMeasuring));
  }
  info_.rate = (static_cast<double>(arrivals.size()) - 1) / (arrivals.back() - arrivals.front());
  if (!ages.empty()) usual_age_ = most_of(ages);
  if (const std::string delay = name.option("delay"); !delay.empty()) {
    info_.delay = milliseconds(delay) / 1e3;
    return;
  }
  check_clocks(ages);
  // Nothing measures how long forces take: assume as long as the quickest pose.
  info_.delay = *usual_age_ + std::max(0.0, std::ranges::min(ages));
}

// Throws if poses have no stamps, or stamps of another clock: then their age is unknown.
void RosDriver::check_clocks(const std::vector<double>& ages) const {
  constexpr const char* kRemedy = "so palpate cannot measure the delay and the stable stiffness";
  if (ages.empty()) {
    throw Error(
        fmt::format("{}: poses on {} have no stamps, {}; give delay=MS, from a pose until "
                    "its force acts",
                    info_.name, link_.pose_topic, kRemedy));
  }
  const auto [youngest, oldest] = std::ranges::minmax(ages);
  if (youngest >= -kClockError && oldest <= kOldest) return;
  throw Error(
      fmt::format("{}: stamps on {} are {:.1f} ms in the {}, {}; synchronise the two machines' "
                  "clocks (chrony), "
                  "or give delay=MS",
                  info_.name, link_.pose_topic, 1e3 * (oldest > kOldest ? oldest : -youngest),
                  oldest > kOldest ? "past" : "future", kRemedy));
}

// Throws if a pose has no stamp, or its age is far from the one measured at start.
void RosDriver::check_age() const {
  if (!usual_age_) return;
  if (!reading_.stamp) {
    throw Error(
        fmt::format("{}: a pose on {} has no stamp, though earlier ones had; have its node "
                    "stamp every pose",
                    info_.name, link_.pose_topic));
  }
  const double off = age() - *usual_age_;
  if (off > -kOldest && off < std::max(*info_.delay, kSilence)) return;
  throw Error(
      fmt::format("{}: a pose with a stamp {:.3g} s from now, when {:.3g} ms were usual; is the "
                  "network slow, or was a clock set?",
                  info_.name, age(), 1e3 * *usual_age_));
}

// Takes every message that waits; false if there is no pose among them.
bool RosDriver::take() {
  reading_.stamp.reset();
  reading_.has_velocity = false;
  for (const auto& other : link_.others) other->take(reading_);
  if (link_.buttons) {
    link_.buttons->take(reading_);
    if (link_.buttons->writers() == 0) reading_.state.buttons = 0;
  }
  const bool posed = link_.pose->take(reading_);
  if (reading_.has_velocity) velocity_time_ = clock_.now();
  return posed;
}

DeviceState RosDriver::exchange_wrench(const Wrench& wrench) {
  const double begin = clock_.now();
  const Eigen::Matrix3d to_node = link_.axes.forces.transpose();
  if (!link_.write({to_node * wrench.force, to_node * wrench.torque})) {
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
  check_one_owner();
  if (!link_.listened())
    throw Error(fmt::format("{}: no node subscribes to {}", info_.name, link_.force_topic));
  check_age();
  const double now = clock_.now();
  if (now - velocity_time_ > kSilence) estimate_velocity(now);
  if (info_.maximum_torque > 0) estimate_turns(now);
  return ours();
}

// From orientations, whatever a node tells: many leave their twists' angular part at zero.
void RosDriver::estimate_turns(double now) {
  const double span = now - turned_time_;
  if (span < kVelocitySpan) return;
  const Eigen::Quaterniond turned = reading_.state.orientation;
  reading_.state.angular_velocity =
      span < 4 * kVelocitySpan ? Vector3d(turn_between(turned_, turned) / span) : Vector3d::Zero();
  turned_ = turned;
  turned_time_ = now;
}

void RosDriver::estimate_velocity(double now) {
  const double span = now - from_time_;
  if (span < kVelocitySpan) return;
  reading_.state.velocity = span < 4 * kVelocitySpan
                                ? Vector3d((reading_.state.position - from_) / span)
                                : Vector3d::Zero();
  from_ = reading_.state.position;
  from_time_ = now;
}

DeviceState RosDriver::ours() const {
  DeviceState state = reading_.state;
  const Eigen::Matrix3d& to_ours = link_.axes.poses;
  state.position = to_ours * state.position;
  state.velocity = to_ours * state.velocity;
  state.orientation = Eigen::Quaterniond(to_ours) * state.orientation;
  state.angular_velocity = to_ours * state.angular_velocity;
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
