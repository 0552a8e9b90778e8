// Measures walls on a simulated device: the stiffest stable one, and the rebound of an impact.
#include "palpate/servo/z_width.hpp"

#include <algorithm>
#include <cmath>

#include "servo/oscillation.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kTime = 2;      // s that a wall is watched (judgement)
constexpr double kShare = 0.25;  // share of that time, at its beginning and at its end (judgement)
constexpr double kSoftest = 1;   // N/m; lower end of the search (judgement)
constexpr double kPrecision = 1.01;  // ratio of stiffnesses at which the search ends (judgement)

// A wall that fills z < 0, or a spring to z = 0.
struct Wall {
  double stiffness;
  bool two_sided;

  [[nodiscard]] Guard::Input felt(const DeviceState& hand, double dt) const {
    Guard::Input input;
    input.hip = hand.position;
    input.velocity = hand.velocity;
    input.dt = dt;
    const double z = hand.position.z();
    if (z >= 0 && !two_sided) return input;
    input.force.z() = -stiffness * z;
    input.normal.z() = z < 0 ? 1 : -1;
    input.stiffness = stiffness;
    return input;
  }
};

SimulatedDeviceOptions free_device(const WallOptions& wall) {
  SimulatedDeviceOptions device = wall.device;
  device.hand = {.stiffness = 0, .damping = 0, .maximum_force = 1};
  device.position.setZero();
  device.velocity.setZero();
  device.maximum_force = 1e6;
  device.duration.reset();
  return device;
}

// No soft start: the device is in the wall from the first step on, and so is what is measured.
GuardOptions bare(const WallOptions& wall) {
  GuardOptions guard = wall.guard;
  guard.soft_start = 0;
  guard.slew = 1e9;
  guard.maximum_force = 1e6;
  guard.silence = 1;
  guard.passivity.mass = wall.device.mass;
  guard.passivity.delay = wall.device.delay;
  return guard;
}

// Steps until `go_on(time, force)`, called with each written force, returns false, or for kTime.
template <class GoOn>
void run(SimulatedDevice& device, const Wall& wall, const WallOptions& options, GoOn go_on) {
  Guard guard(bare(options));
  const double dt = 1 / options.device.rate;
  const auto steps = static_cast<int>(kTime * options.device.rate);
  for (int i = 0; i < steps; ++i) {
    const DeviceState hand = device.read();
    const Vector3d force = guard.pass(wall.felt(hand, dt));
    device.write(force);
    if (!go_on(i * dt, force)) return;
  }
}

// The stiffness at which `good` ends; what is good at a stiffness is so below.
template <class Good>
double largest(Good good) {
  if (!good(kSoftest)) return 0;
  double low = kSoftest;
  double high = low;
  while (high < kStiffestWall && good(high)) {
    low = high;
    high *= 2;
  }
  if (high >= kStiffestWall && good(kStiffestWall)) return kStiffestWall;
  while (high > kPrecision * low) {
    const double middle = std::sqrt(low * high);
    (good(middle) ? low : high) = middle;
  }
  return low;
}

// Let go from `stretch`, where the wall holds from both sides: the oscillation at the end over that
// at the beginning. Above 1 the wall is unstable.
double growth(const WallOptions& wall) {
  SimulatedDeviceOptions options = free_device(wall);
  options.position.z() = wall.stretch;
  SimulatedDevice device(options);
  double first = 0;
  double last = 0;
  run(device, {wall.stiffness, true}, wall, [&](double time, const Vector3d&) {
    const double away = std::abs(device.true_position().z());
    if (time < kShare * kTime) first = std::max(first, away);
    if (time > (1 - kShare) * kTime) last = std::max(last, away);
    return away < 1e3 * wall.stretch;
  });
  return last > 0 ? last / first : first / wall.stretch;
}

}  // namespace

Impact impact(const WallOptions& wall) {
  SimulatedDeviceOptions options = free_device(wall);
  options.position.z() = options.resolution;
  options.velocity.z() = -wall.speed;
  SimulatedDevice device(options);
  Impact result;
  bool inside = false;
  double speed_in = wall.speed;
  int free_steps = 0;
  run(device, {wall.stiffness, false}, wall, [&](double, const Vector3d& force) {
    const Vector3d& position = device.true_position();
    const double speed = device.true_velocity().z();
    if (!inside && position.z() < 0) {
      inside = true;
      speed_in = -speed;
    }
    const bool left = inside && position.z() >= 0 && force.isZero(0);
    free_steps = left ? free_steps + 1 : 0;
    if (free_steps <= wall.device.delay) return true;  // a force may still be delayed
    result.rebound = std::max(0.0, speed) / speed_in;
    return false;
  });
  result.energy = device.work();
  return result;
}

double stable_stiffness(WallOptions wall) {
  return largest([&](double stiffness) {
    wall.stiffness = stiffness;
    return growth(wall) <= 1;
  });
}

double rebound_stiffness(WallOptions wall) {
  return largest([&](double stiffness) {
    wall.stiffness = stiffness;
    return impact(wall).rebound <= 1;
  });
}

}  // namespace palpate
