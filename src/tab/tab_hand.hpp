// Declares the simulated hand of a tab.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "palpate/base/clock.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "session/led_hand.hpp"
#include "session/page_hand.hpp"

namespace palpate::tab {

/// s; steps that are later are left out: a hand's command is as old at most (judgement).
inline constexpr double kMostLate = 0.1;

/// A command that is overdue counts as a release.
[[nodiscard]] inline ServoOptions servo_options(const Placement& placement) {
  ServoOptions options;
  options.proxy.stiffness = placement.stiffness;
  session::set_for_pages(options);
  options.guard.silence = std::numeric_limits<double>::infinity();
  options.workspace = placement.workspace;
  return options;
}

/// A simulated hand that a page may take: it, its servo and the time that is simulated of both.
struct TabHand {
  TabHand(Scene& scene, const Clock& stopwatch)
      : clock(stopwatch),
        placement(place_device(scene, {}, {})),
        guide(remote, {}, {.speed = session::kReachingSpeed}),
        device({}, guide),
        servo(device, scene, servo_options(placement)),
        led(remote, placement.workspace, scene) {}

  // `before`: is called with the time of each step, s; what it takes is not the step's.
  template <class Before>
  void step(double lateness, const Before& before) {
    const DeviceState read = device.read();
    const double begin = clock.now();
    before(read.time);
    elsewhere += clock.now() - begin;
    servo.step(read, read.time);
    servo.write();
    servo.show({.lateness = lateness, .computing = computing});
    ++steps;
  }

  // Clocks of browsers are too coarse for one step: the mean of all of a call counts.
  template <class Before>
  int step_up_to(double now, const Before& before) {
    const double rate = device.info().rate;
    if (!start) start = now;
    const auto behind = [&] { return now - *start - static_cast<double>(steps) / rate; };
    if (behind() > kMostLate) *start += behind() - kMostLate;
    const double begin = clock.now();
    int count = 0;
    elsewhere = 0;
    for (; behind() >= 0; ++count) step(behind(), before);
    if (count > 0) computing = (clock.now() - begin - elsewhere) / count;
    return count;
  }

  const Clock& clock;  // of computing times alone
  Placement placement;
  RemoteTarget remote;
  TeleoperatedHand guide;
  SimulatedDevice device;
  Servo servo;
  session::LedHand led;
  std::optional<double> start;  // when the device's time was 0
  std::uint64_t steps = 0;
  double heard = 0;      // when the page said something last
  double computing = 0;  // of a step, s, in the call before
  double elsewhere = 0;  // before steps, s, in this call
};

}  // namespace palpate::tab
