#include "events/rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "events/draft.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kRates[] = {15, 30, 60, 90};

// An arm passes between the camera and a pressed table, which it hides for so long.
Event hidden_by_arm(std::uint64_t seed) {
  Draft draft(seed);
  draft.press(draft.place, kUp);
  const Vector3d view = draft.to_camera(draft.place);
  const double radius = draft.between(0.02, 0.045);
  const double hidden = draft.one_of({0.1, 0.3, 1.0, 3.0});
  const double speed = std::min(1.5, 2 * radius / hidden);
  const Vector3d way = view.cross(kUp).normalized() * (draft.between(0, 1) < 0.5 ? 1 : -1);
  const double begin = draft.now();
  const double length = 2 * radius + 0.2;
  const Vector3d middle = draft.place + draft.between(0.12, 0.25) * view;
  SimulatedSolid& arm = draft.cylinder(middle - 0.5 * length * way, view.cross(way), radius, 0.5);
  arm.motion.velocity = speed * way;
  arm.motion.begin = begin;
  arm.motion.end = begin + length / speed;
  draft.hold(length / speed + 0.5);
  return draft.event;
}

// A box is put before it, and stays.
Event hidden_by_box(std::uint64_t seed) {
  Draft draft(seed);
  draft.press(draft.place, kUp);
  const Vector3d view = draft.to_camera(draft.place);
  SimulatedSolid& box = draft.block(draft.place + draft.between(0.1, 0.25) * view, view,
                                    Vector3d::Constant(draft.between(0.02, 0.05)));
  Draft::comes(box, draft.now() + 0.1);
  draft.hold(draft.one_of({0.5, 1.5, 3.0}));
  return draft.event;
}

// An arm passes through where the hand rests, pressed to nothing.
Event swept(std::uint64_t seed) {
  Draft draft(seed);
  const Vector3d hip = draft.place + draft.between(0.08, 0.16) * kUp;
  draft.start(hip);
  draft.hold(1);
  draft.happens();
  const double radius = draft.between(0.02, 0.045);
  const double speed = draft.between(0.1, 1);
  const Vector3d way = (draft.level_direction() + draft.between(-0.3, 0.3) * kUp).normalized();
  const Vector3d aside = way.cross(draft.to_camera(hip)).normalized();
  const double begin = draft.now();
  const Vector3d miss = draft.between(-0.5, 0.5) * radius * way.cross(aside);
  SimulatedSolid& arm = draft.cylinder(hip + miss - 0.2 * way, aside, radius, 0.4);
  arm.motion.velocity = speed * way;
  arm.motion.begin = begin;
  arm.motion.end = begin + 0.4 / speed;
  draft.hold(0.4 / speed + 0.5);
  return draft.event;
}

Event vanishes(std::uint64_t seed) {
  Draft draft(seed);
  const double half = draft.between(0.02, 0.04);
  SimulatedSolid& box = draft.block(draft.place + half * kUp, kUp, Vector3d::Constant(half));
  draft.press(draft.place + 2 * half * kUp, kUp);
  draft.event.depth = 0;
  Draft::goes(box, draft.now() + draft.between(0.05, 0.1));
  draft.hold(1.2);
  return draft.event;
}

// A face appears so far before (> 0) or behind where a hand rests in the air.
Event appears(std::uint64_t seed, double before) {
  Draft draft(seed);
  const Vector3d hip = draft.place + draft.between(0.1, 0.16) * kUp;
  draft.start(hip);
  draft.hold(1);
  draft.happens();
  const Vector3d view = draft.to_camera(hip);
  const double half = draft.between(0.02, 0.04);
  SimulatedSolid& box = draft.block(hip + (before - half) * view, view, Vector3d::Constant(half));
  Draft::comes(box, draft.now() + draft.between(0.05, 0.1));
  draft.hold(1.5);
  return draft.event;
}

// The same before a surface that the hand presses.
Event appears_on(std::uint64_t seed, double before) {
  Draft draft(seed);
  draft.press(draft.place, kUp);
  SimulatedSolid& box =
      draft.block(draft.place + (before - 0.1) * kUp, kUp, Vector3d(0.04, 0.04, 0.1));
  Draft::comes(box, draft.now() + draft.between(0.05, 0.1));
  draft.event.depth = kPress;
  draft.hold(1.5);
  return draft.event;
}

// What the hand presses goes to and fro along its normal, and the hand with what can be felt of it.
Event to_and_fro(std::uint64_t seed, double speed, bool ball) {
  constexpr double kDepth = 0.01;  // m
  Draft draft(seed);
  draft.event.camera.rate = draft.one_of(kRates);
  const double swing = std::min(0.1, 0.3 * speed);
  const Vector3d place(draft.place.x(), draft.place.y(), 0);
  const Vector3d out = ball ? draft.to_camera(place) : kUp;
  auto& solids = draft.event.scene.solids;
  solids.resize(1);
  if (ball) {
    const double radius = draft.between(0.06, 0.15);
    solids[0].solid.T_world_solid.translation() = -2 * kUp;
    solids.push_back(
        {{SolidKind::ball, Eigen::Isometry3d::Identity(), Vector3d::Constant(radius)}, {}});
    solids.back().solid.T_world_solid.translation() = place - radius * out;
  }
  SimulatedMotion& motion = solids.back().motion;
  motion.frequency = speed / (2 * std::numbers::pi * swing);
  motion.swing = swing * out;
  motion.phase = draft.between(0, 6);
  // A surface is felt 10 ms after its frame was taken, and is there a frame later.
  const double lag = 0.01 + 1 / draft.event.camera.rate;
  const auto seconds = 1.6 + std::clamp(2 / motion.frequency, 1.0, 4.0);
  for (double t = 0; t < seconds; t += kTick) {
    const double height =
        swing * std::sin(2 * std::numbers::pi * motion.frequency * (t - lag) + motion.phase);
    const double depth = std::clamp(0.1 * (t - 0.6), -0.02, kDepth);
    draft.event.hip.emplace_back(place + (height - depth) * out);
  }
  draft.event.begin = 1000;
  draft.event.depth = kDepth;
  return draft.event;
}

// From behind a plate that the camera sees from the front, out, and then onto it.
Event from_behind(std::uint64_t seed) {
  Draft draft(seed);
  const Vector3d middle = draft.place + draft.between(0.1, 0.16) * kUp;
  const Vector3d out = draft.to_camera(middle);
  draft.block(middle - 0.003 * out, out, Vector3d(0.05, 0.05, 0.003));
  draft.start(middle - 0.05 * out);
  draft.hold(0.6);
  draft.happens();
  draft.go(middle + 0.03 * out, draft.between(0.03, 0.15));
  return draft.event;
}

// The same, and back again: then it holds.
Event back_again(std::uint64_t seed) {
  Event event = from_behind(seed);
  Draft draft(seed);
  draft.event = event;
  const Vector3d middle = event.scene.solids.back().solid.T_world_solid.translation();
  const Vector3d out = draft.to_camera(middle);
  draft.go(middle + (0.003 - kPress) * out, 0.05);
  draft.hold(0.3);
  draft.happens();
  draft.hold(0.5);
  draft.event.depth = kPress;
  return draft.event;
}

// After the last of some frames the hand goes where it has not been.
Event ended(std::uint64_t seed, int frames) {
  Draft draft(seed);
  draft.event.camera.frames = frames;
  draft.event.camera.noise.model.coefficients = {draft.between(0.001, 0.006), 0, 0};
  draft.start(draft.place + 0.05 * kUp);
  draft.hold(frames / 30.0 + 0.5);
  for (int i = 0; i < 4; ++i) {
    const Vector3d next(draft.between(-0.12, 0.12), draft.between(-0.15, 0.15), 0);
    draft.go(next + 0.02 * kUp, 0.2);
    draft.go(next - kPress * kUp, 0.05);
    draft.hold(0.1);
    if (i == 0) draft.happens();
    draft.go(next + 0.04 * draft.level_direction() - kPress * kUp, 0.05);
    draft.go(draft.event.hip.back() + 0.02 * kUp, 0.1);
  }
  draft.event.depth = kPress;
  draft.event.when_deep = true;
  return draft.event;
}

}  // namespace

std::vector<Row> all_rows() {
  std::vector<Row> rows = {{"hidden by an arm", hidden_by_arm},
                           {"hidden by a box", hidden_by_box},
                           {"an arm sweeps over a hand", swept},
                           {"vanishes", vanishes}};
  for (const double mm : {30., 15., 5., -5., -15., -30.}) {
    rows.push_back({fmt::format("appears {} mm before a hand", mm),
                    [mm](std::uint64_t seed) { return appears(seed, 1e-3 * mm); }});
  }
  for (const double mm : {30., 15., 5.}) {
    rows.push_back({fmt::format("appears {} mm over a pressed table", mm),
                    [mm](std::uint64_t seed) { return appears_on(seed, 1e-3 * mm); }});
  }
  for (const double speed : {0.02, 0.1, 0.3, 0.5, 1.0}) {
    for (const bool ball : {false, true}) {
      rows.push_back({fmt::format("{} to and fro at {} m/s", ball ? "ball" : "plane", speed),
                      [=](std::uint64_t seed) { return to_and_fro(seed, speed, ball); }});
    }
  }
  rows.push_back({"from behind a plate", from_behind});
  rows.push_back({"and back onto it", back_again});
  for (const int frames : {1, 3, 30}) {
    rows.push_back({fmt::format("ended after {} frames", frames),
                    [=](std::uint64_t seed) { return ended(seed, frames); }});
  }
  return rows;
}

}  // namespace palpate::events
