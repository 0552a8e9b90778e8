// The guard of a hand that feels torque or grip besides force.
#pragma once

#include <Eigen/Core>

#include "palpate/device/device.hpp"
#include "palpate/servo/guard.hpp"
#include "servo/guard_chain.hpp"
#include "tool/motion.hpp"

namespace palpate {

/// Axes of force, torque over gyration, and grip, all N: the metric of docs/method.md 3.7, in which
/// a turn is a length and each link of the guard is what it is for a force.
struct WrenchAxes {
  /// Guard::Input in this metric.
  struct Input {
    Motion force = Motion::Zero();
    Motion normal = Motion::Zero();
    Motion drift = Motion::Zero();
    Motion hip = Motion::Zero();  ///< the turns of all steps since a fault, added up
    Motion velocity = Motion::Zero();
    double dt = 0;
    bool fresh = true;
    double stiffness = 0;
    bool felt = true;
    bool softened = false;
    Guard::Fault fault = Guard::Fault::none;
  };

  double maximum_force = 0;   // N
  double maximum_torque = 0;  // over gyration, N
  double maximum_grip = 0;    // N

  /// Each part by itself: motors of a wrist that are weak take nothing from the force.
  [[nodiscard]] Motion shortened(const Motion& force) const noexcept;
};

/// Everything between a tool's wrench and a device that renders torque or grip: the links of Guard
/// on all axes at once, in the metric of the gyration. So torque slews by S times the gyration, a
/// turn is damped by B times its square, and one ledger counts F . v + tau . w + grip . do of what
/// the device was sent. What it does not render is zero, and its axes are those of a surface that
/// moves by itself (HeldTool::drift). One thread. Real-time but for construction.
class WrenchGuard {
 public:
  /// `options`: fitted to the device, in the world; `scale`: Workspace::scale; `gyration`: of the
  /// tool's proxy, m. @throws Error as Guard.
  WrenchGuard(const GuardOptions& options, const DeviceInfo& device, double scale, double gyration);

  /// What a step's wrench came from, besides Guard::Input.
  struct Turn {
    Wrench wrench;  ///< of the tool, world; the force is that of Guard::Input, which may be more
    Pose hand;      ///< of which the position is that of Guard::Input
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the hand's turns, rad/s, world
  };

  /// What may go to the device, in the world. Finite, whatever the input.
  [[nodiscard]] Wrench pass(const Guard::Input& input, const Turn& turn) noexcept;
  /// Guard::reset()
  void reset() noexcept;
  [[nodiscard]] const Guard::State& state() const noexcept { return chain_.state(); }

  [[nodiscard]] bool renders_torque() const noexcept { return renders_torque_; }
  [[nodiscard]] bool renders_grip() const noexcept { return renders_grip_; }

 private:
  // Without what the device does not render.
  [[nodiscard]] Motion rendered(const Eigen::Vector3d& first, const Eigen::Vector3d& turn,
                                double opening) const noexcept;

  bool renders_torque_;
  bool renders_grip_;
  double gyration_;  // m
  GuardChain<WrenchAxes> chain_;
  Pose hand_;                                         // in the last step
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero();  // turns of all steps, rad
  double opened_ = 0;                                 // m, since the hand was read last
  double waited_ = 0;                                 // s, since then
  double opening_ = 0;                                // m/s, when it was
  bool started_ = false;
};

}  // namespace palpate
