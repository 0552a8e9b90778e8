// A client of a remote device in simulated time, which holds a force from packet to packet while
// its hand goes on.
#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "palpate/device/device.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::test {

/// Where a client's hand truly is at any time, s.
using HandWay = std::function<Pose(double)>;

/// When a client sends, and when what it sent arrives.
struct Sending {
  double rate = 1000;      ///< packets a second
  double jitter = 0;       ///< of a period, either way
  double stall = 0;        ///< s that it stands still, its hand moving, every 0.4 s or so
  double burst = 0;        ///< s of packets that arrive together; what it gets comes as late
  bool yields = false;     ///< the hand is a light grip on 0.1 kg that wants to go its way
  bool tells_time = true;  ///< false: each step's position counts as a new reading
};

/// What a hand of given ways was given, and how its force changed.
struct Pushed {
  double energy = 0;       ///< most that whole periods of the motion gave, and all of it, J
  double step = 0;         ///< largest change of force between steps beyond the hand's, N
  double torque_step = 0;  ///< the same of torque, N m
  double largest = 0;      ///< N
};

/// Lets a client with `sending` follow `way`, which repeats itself every 2 s from 4 s on, at a
/// surface for `duration` (s) of 1 kHz steps. `turns`: the client tells orientations and renders
/// torque.
[[nodiscard]] Pushed push(Scene& scene, const ServoOptions& options, const Sending& sending,
                          const HandWay& way, double duration, bool turns = false);

}  // namespace palpate::test
