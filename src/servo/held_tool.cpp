// Steps a tool, and makes of its contact what a guard needs.
#include "servo/held_tool.hpp"

#include <algorithm>
#include <cmath>

#include "tool/motion.hpp"

namespace palpate {

using Eigen::Vector3d;

HeldTool::HeldTool(Scene& scene, const ServoOptions& options, const DeviceInfo& device,
                   double limit)
    : field_(scene, options.tool, options.field, "a tool's field", options.workspace.scale),
      proxy_(options.tool, {.stiffness = std::min(options.proxy.stiffness, limit),
                            .friction = options.proxy.friction,
                            .texture = options.proxy.texture,
                            .gyration = options.gyration}) {
  const bool grips = device.maximum_grip > 0 && options.tool->opens();
  if (!(device.maximum_torque > 0) && !grips) return;
  const double scale = options.workspace.scale;
  guard_.emplace(in_world(options.guard, scale), device, scale, proxy_.options().gyration);
}

void HeldTool::reset(const Pose& hand) noexcept {
  proxy_.reset(hand);
  hand_ = hand;
  wrench_ = {};
  if (guard_) guard_->reset();
}

Contact HeldTool::step(double now, const Pose& hand, double dt) noexcept {
  if (!started_) reset(hand);
  started_ = true;
  field_.update(now, hand, proxy_);
  const ToolContact tool = proxy_.step(field_, hand, dt);
  wrench_ = tool.wrench;
  Contact contact;
  contact.force = wrench_.force;
  contact.proxy = tool.proxy.position;
  contact.stiffness = tool.stiffness;
  contact.touching = tool.touching;
  contact.sliding = tool.sliding;
  contact.source = tool.source;
  contact.iterations = tool.iterations;
  contact.evaluations = tool.evaluations;
  contact.notes = tool.notes;
  if (!contact.force.isZero(0)) contact.normal = contact.force.normalized();
  contact.drift = drift(hand, dt);
  hand_ = hand;
  return contact;
}

// F . v - F . drift = F . v + tau . w + grip . do, but for what the device renders of the last two.
// No part of the tool moves faster by the turn than its extent allows, so no lever is longer.
Vector3d HeldTool::drift(const Pose& hand, double dt) const noexcept {
  const double force = wrench_.force.norm();
  if (!(dt > 0) || !(force > 0)) return Vector3d::Zero();
  const Vector3d turn = turn_between(hand_.orientation, hand.orientation) / dt;
  const double opening = (hand.opening - hand_.opening) / dt;
  double power = 0;  // that the hand does without feeling it, W
  double fastest = 0;
  if (!guard_ || !guard_->renders_torque()) {
    power -= wrench_.torque.dot(turn);
    fastest += proxy_.tool().extent() * turn.norm();
  }
  if (!guard_ || !guard_->renders_grip()) {
    power -= wrench_.grip * opening;
    fastest += 0.5 * std::abs(opening);
  }
  const double speed = std::clamp(power / force, -fastest, fastest);
  return speed / force * wrench_.force;
}

}  // namespace palpate
