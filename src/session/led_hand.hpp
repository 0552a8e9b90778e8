// Leads a simulated hand for a page.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "palpate/device/device.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::session {

/// Takes a hand where a page wants it. Where the page says from where it sees the place, the hand
/// goes there by itself: lifted on its own side of what it touches, and through free space as the
/// newest surfaces show it, off each point by its own R. Where they show no free way within 2000
/// searches for a nearest point it goes straight, slowly and with 0.5 N, and with as little where
/// it touches on its way; then another way is looked for. So it goes with a tool that has a body,
/// also on a way: that is looked at for a point. With a limited force it comes down on the place at
/// 0.1 m/s. One thread at a time moves it; not real-time.
class LedHand {
 public:
  /// All outlive it.
  LedHand(RemoteTarget& remote, const Workspace& workspace, const Scene& scene)
      : remote_(remote), workspace_(workspace), scene_(scene) {}

  /// `target`, and the `eye` that sees it: world frame. `servo` is the hand's. `stamp`: s; grows.
  void move(const TargetSource::Target& target, const std::optional<Eigen::Vector3d>& eye,
            const Servo& servo, double stamp);
  void release();

 private:
  void plan(const Eigen::Vector3d& goal, const Eigen::Vector3d& eye, bool touches,
            const ServoState& state);

  RemoteTarget& remote_;
  const Workspace& workspace_;
  const Scene& scene_;
  std::optional<Eigen::Vector3d> goal_;  // that the way before was planned for, m, world
  double near_ = 0;                      // m, world: a goal so near to it is the same
  bool touches_ = false;                 // it comes down on the goal
  bool clear_ = false;                   // nothing is in the way
  double planned_ = 0;                   // s, when
  Way way_;
};

}  // namespace palpate::session
