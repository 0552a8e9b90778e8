// Records durations of steps and recent forces of a servo, and adapts its guard to the device.
#include "servo/servo_inside.hpp"

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "palpate/servo/z_width.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "servo/passivity.hpp"

namespace palpate {
namespace {

constexpr double kShortest = 1.25e-7;  // s; lower end of the first bin, 1/8 us (judgement)
constexpr double kLongest = 1e6;       // s; longer durations count as this (judgement)

// Device periods without a step that trip the watchdog, at least (docs/method.md 8.6)
constexpr double kSilencePeriods = 2.5;

std::size_t bin_of(double duration) noexcept {
  if (duration <= kShortest) return 0;
  const double octaves = std::log2(duration / kShortest);
  const auto bin = static_cast<std::size_t>(octaves * Durations::kPerOctave);
  return std::min(bin, Durations::kBins - 1);
}

double middle_of(std::size_t bin) noexcept {
  return kShortest * std::exp2((static_cast<double>(bin) + 0.5) / Durations::kPerOctave);
}

constexpr int kButtons = 32;  // bits of DeviceState::buttons

// m at the hand: a stiffness is lowered rather than a gyration below it, as fingers are as far from
// the axis of what they turn (judgement).
constexpr double kLeastGyration = 0.01;

bool turns(const DeviceInfo& device, const ServoOptions& options) noexcept {
  return options.tool && options.guard.on && device.maximum_torque > 0;
}

// The stiffness at the hand up to which turns are passive: K g^2 <= 2 (b + B g^2) / (T + 2 T_d), in
// the metric of a gyration g (m), at the hand as well.
double turning_limit(DeviceInfo device, const GuardOptions& guard, double gyration) noexcept {
  device.damping = device.angular_damping / (gyration * gyration);
  return guard.stiffness_share * passive_stiffness(device, guard.damping);
}

// The largest gyration up to the tool's with which turns are passive, but kLeastGyration; m, world.
double passive_gyration(const DeviceInfo& device, const ServoOptions& options) {
  const double scale = options.workspace.scale;
  const double wanted = ToolProxy(options.tool).options().gyration / scale;
  const double felt =
      std::min(options.proxy.stiffness, stiffness_limit_of(device, options).told) * scale;
  DeviceInfo turning = device;
  turning.damping = 0;
  const double damped =
      options.guard.stiffness_share * passive_stiffness(turning, options.guard.damping);
  if (!(felt > damped)) return wanted * scale;
  turning.damping = device.angular_damping;
  const double by_device = options.guard.stiffness_share * passive_stiffness(turning, 0);
  const double stable = std::sqrt(by_device / (felt - damped));
  return scale * std::max(std::min(wanted, stable), std::min(wanted, kLeastGyration));
}

}  // namespace

void Durations::add(double duration) noexcept {
  if (std::isnan(duration)) return;
  const double length = std::clamp(duration, 0.0, kLongest);
  ++counts[bin_of(length)];
  ++count;
  sum += length;
  longest = std::max(longest, length);
}

double Durations::quantile(double p) const noexcept {
  if (count == 0) return 0;
  const double wanted = std::clamp(p, 0.0, 1.0) * static_cast<double>(count);
  double below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += static_cast<double>(counts[bin]);
    if (below >= wanted && below > 0) return std::min(middle_of(bin), longest);
  }
  return longest;
}

Durations Durations::since(const Durations& earlier) const noexcept {
  Durations later = *this;
  for (std::size_t bin = 0; bin < kBins; ++bin) later.counts[bin] -= earlier.counts[bin];
  later.count -= earlier.count;
  later.sum -= earlier.sum;
  return later;
}

// Only one thread adds, so a relaxed load and store lose nothing.
void Histogram::add(double duration) noexcept {
  if (std::isnan(duration)) return;
  constexpr auto kRelaxed = std::memory_order_relaxed;
  const double length = std::clamp(duration, 0.0, kLongest);
  auto& count = counts_[bin_of(length)];
  count.store(count.load(kRelaxed) + 1, kRelaxed);
  sum_.store(sum_.load(kRelaxed) + length, kRelaxed);
  longest_.store(std::max(longest_.load(kRelaxed), length), kRelaxed);
}

Durations Histogram::look() const noexcept {
  Durations seen;
  for (std::size_t bin = 0; bin < Durations::kBins; ++bin) {
    seen.counts[bin] = counts_[bin].load(std::memory_order_relaxed);
    seen.count += seen.counts[bin];
  }
  seen.sum = sum_.load(std::memory_order_relaxed);
  seen.longest = longest_.load(std::memory_order_relaxed);
  return seen;
}

void RecentForces::add(const Eigen::Vector3f& force) noexcept {
  const std::uint64_t count = count_.load(std::memory_order_relaxed);
  Slot& slot = forces_[count % kSteps];
  for (std::size_t i = 0; i < 3; ++i) {
    slot[i].store(force[static_cast<Eigen::Index>(i)], std::memory_order_release);
  }
  count_.store(count + 1, std::memory_order_release);
}

std::vector<Eigen::Vector3f> RecentForces::since(std::uint64_t& seen) const {
  const std::uint64_t end = count_.load(std::memory_order_acquire);
  const std::uint64_t oldest = end > kSteps ? end - kSteps : 0;
  const std::uint64_t begin = std::max(std::min(seen, end), oldest);
  std::vector<Eigen::Vector3f> forces;
  forces.reserve(static_cast<std::size_t>(end - begin));
  for (std::uint64_t i = begin; i < end; ++i) {
    const Slot& slot = forces_[i % kSteps];
    forces.emplace_back(slot[0].load(std::memory_order_acquire),
                        slot[1].load(std::memory_order_acquire),
                        slot[2].load(std::memory_order_acquire));
  }
  // The step that is in progress writes over the slot of the one kSteps before it.
  const std::uint64_t now = count_.load(std::memory_order_acquire);
  const std::uint64_t whole = now >= kSteps ? now - kSteps + 1 : 0;
  const std::uint64_t lost = whole > begin ? std::min(whole, end) - begin : 0;
  forces.erase(forces.begin(), forces.begin() + static_cast<std::ptrdiff_t>(lost));
  seen = end;
  return forces;
}

ServoOptions options_for(const DeviceInfo& device, ServoOptions options) {
  Requirement{"device"}(device.maximum_force >= 0, "maximum_force (N)", device.maximum_force,
                        "give what it can hold, 0 for none");
  const int button = options.clutch_button.value_or(0);
  Requirement{"servo"}(button >= 0 && button < kButtons, "clutch_button", button,
                       "give a button from 0 to 31");
  Requirement{"device"}(device.maximum_torque >= 0, "maximum_torque (N m)", device.maximum_torque,
                        "give what it can hold, 0 for none");
  Requirement{"device"}(device.maximum_grip >= 0, "maximum_grip (N)", device.maximum_grip,
                        "give what it can hold, 0 for none");
  options.guard = guard_for(device, options.guard);
  if (turns(device, options) && options.gyration == 0) {
    options.gyration = passive_gyration(device, options);
  }
  return options;
}

StiffnessLimit stiffness_limit_of(const DeviceInfo& device, const ServoOptions& options) {
  const GuardOptions& guard = options.guard;
  StiffnessLimit limit;
  if (!guard.on) return limit;
  const double scale = options.workspace.scale;
  double felt = guard.stiffness_share * passive_stiffness(device, guard.damping);
  if (turns(device, options) && options.gyration > 0) {
    felt = std::min(felt, turning_limit(device, guard, options.gyration / scale));
  }
  limit.passive = limit.told = felt / scale;
  if (device.maximum_stiffness > 0) {
    limit.told = std::min(felt, device.maximum_stiffness) / scale;
  }
  if (!(device.rate > 0)) return limit;
  const double period = 1 / device.rate;
  limit.span = period + 2 * device.delay.value_or(period);
  // PassivityOf::strongest() of readings that are further apart than the delay is.
  if (guard.damping > 0) limit.damped = guard.passivity.mass / (4 * guard.damping);
  return limit;
}

GuardOptions guard_for(const DeviceInfo& device, GuardOptions options) {
  if (device.maximum_force > 0) {
    options.maximum_force =
        std::min(options.maximum_force, Servo::kForceShare * device.maximum_force);
  }
  if (device.mass > 0) options.passivity.mass = device.mass;
  if (device.delay) {
    const double steps = std::round(*device.delay * device.rate);
    options.passivity.delay =
        static_cast<int>(std::clamp<double>(steps, 0, Passivity::kMaximumDelay));
  }
  if (device.rate > 0) options.silence = std::max(options.silence, kSilencePeriods / device.rate);
  return options;
}

}  // namespace palpate
