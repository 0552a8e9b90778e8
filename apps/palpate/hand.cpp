#include "apps/palpate/hand.hpp"

#include <limits>
#include <utility>

#include "apps/palpate/progress.hpp"
#include "apps/palpate/touch_surface.hpp"
#include "apps/palpate/touch_usage.hpp"
#include "palpate/device/scripted.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate::app {

namespace {

// The hand is where `way` says, whatever the force.
void play_back(Hand& hand, Trajectory way) {
  hand.steps = way.size();
  hand.device = std::make_unique<ScriptedDevice>(std::move(way));
}

Hand scripted(const TouchOptions& options, Trajectory trajectory) {
  Hand hand;
  hand.stiffness = options.stiffness.value_or(kStiffness);
  play_back(hand, std::move(trajectory));
  return hand;
}

// The hand is pulled along `target` again and again, unless somebody takes the tool.
void guide(Hand& hand, const TouchOptions& options, SimulatedDeviceOptions device,
           Trajectory target) {
  device.duration = options.duration;
  hand.remote = std::make_unique<RemoteHand>();
  hand.guide = std::make_unique<GuidedHand>(*hand.remote, std::move(target));
  hand.device = std::make_unique<SimulatedDevice>(device, *hand.guide);
}

// The hand is pulled along `target`, whose times begin at 0.
void simulate(Hand& hand, const TouchOptions& options, Trajectory target) {
  SimulatedDeviceOptions device;
  device.rate = options.rate.value_or(device.rate);
  if (options.view.wanted) return guide(hand, options, device, std::move(target));
  hand.steps = static_cast<std::size_t>(target.back().time * device.rate) + 2;
  hand.device = std::make_unique<SimulatedDevice>(device, std::move(target));
}

Hand simulated(const TouchOptions& options, Trajectory trajectory) {
  Hand hand;
  hand.stiffness = options.stiffness.value_or(kStiffness);
  const double start = trajectory.front().time;
  for (TrajectoryRow& row : trajectory) row.time -= start;
  // Encoders count from where the hand begins, so that far from the origin nothing is lost.
  hand.workspace.T_world_device.translation() = trajectory.front().position;
  for (TrajectoryRow& row : trajectory) {
    row.position = hand.workspace.position_to_device(row.position);
  }
  simulate(hand, options, std::move(trajectory));
  return hand;
}

Hand exploring(const TouchOptions& options, const Scene& scene, const FieldOptions& field) {
  Hand hand;
  PlanOptions plan;
  plan.duration = options.duration.value_or(plan.duration);
  plan.stiffness = options.stiffness.value_or(0);
  plan.tool_radius = options.tool_radius;
  plan.seed = options.seed.value_or(plan.seed);
  plan.rate = options.rate.value_or(plan.rate);
  const bool pulled = options.device != "scripted";
  if (!pulled) plan.hand.stiffness = std::numeric_limits<double>::infinity();
  Progress progress("planning the exploration");
  plan.progress = [&](double done) { progress.update(done); };
  hand.plan = plan_exploration(scene, field, plan);
  hand.workspace = hand.plan->workspace;
  hand.stiffness = hand.plan->stiffness;
  if (pulled) {
    simulate(hand, options, hand.plan->target);
  } else {
    play_back(hand, hand.plan->target);
  }
  return hand;
}

}  // namespace

Trajectory read_way(const TouchOptions& options) {
  if (options.trajectory.empty()) return {};
  Trajectory way = read_trajectory(options.trajectory);
  check_trajectory(options, way);
  return way;
}

Hand make_hand(const TouchOptions& options, Trajectory way, const Scene& scene,
               const FieldOptions& field) {
  if (way.empty()) return exploring(options, scene, field);
  if (options.device == "simulated") return simulated(options, std::move(way));
  return scripted(options, std::move(way));
}

}  // namespace palpate::app
