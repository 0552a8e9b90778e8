// Steps a tool, and makes of its contact what a guard of forces needs.
#include "servo/held_tool.hpp"

#include <algorithm>

#include "palpate/base/error.hpp"
#include "tool/motion.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

const ServoOptions& without_traces(const ServoOptions& options) {
  if (options.traces != nullptr) {
    throw Error(
        "servo: steps of a tool that turns cannot be traced; leave out the tool or the traces");
  }
  return options;
}

}  // namespace

HeldTool::HeldTool(Scene& scene, const ServoOptions& options, double limit)
    : field_(scene, without_traces(options).tool, options.field, "a tool's field",
             options.workspace.scale),
      proxy_(options.tool, {.stiffness = std::min(options.proxy.stiffness, limit),
                            .friction = options.proxy.friction,
                            .gyration = options.gyration}) {}

void HeldTool::reset(const Pose& hand) noexcept {
  proxy_.reset(hand);
  hand_ = hand;
  wrench_ = {};
}

Contact HeldTool::step(double now, const Pose& hand, double dt) noexcept {
  if (!started_) reset(hand);
  started_ = true;
  field_.update(now, hand, proxy_.pose());
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

// F . v - F . drift = F . v + tau . w. No part of the tool moves faster by the turn than its extent
// allows, so no lever is longer.
Vector3d HeldTool::drift(const Pose& hand, double dt) const noexcept {
  const double force = wrench_.force.norm();
  if (!(dt > 0) || !(force > 0)) return Vector3d::Zero();
  const Vector3d turn = turn_between(hand_.orientation, hand.orientation) / dt;
  const double fastest = proxy_.tool().extent() * turn.norm();
  const double speed = std::clamp(-wrench_.torque.dot(turn) / force, -fastest, fastest);
  return speed / force * wrench_.force;
}

}  // namespace palpate
