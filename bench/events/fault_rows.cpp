// A sensor is at fault where a hand presses: it is silent, sees a hole, changes its resolution,
// does not know where it stands, sees the user's own finger, or is a ToF camera before a floor.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "drawn_cameras.hpp"
#include "events/draft.hpp"
#include "events/rows.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kBack = 0.3;  // s in which the force has to be back

// The table alone, so that nothing hides the place.
Draft bare(std::uint64_t seed) {
  Draft draft(seed);
  draft.event.scene.solids.resize(1);
  return draft;
}

bool is_within(double time, double from, double length) {
  return time >= from && time < from + length;
}

// The fault is over after so long; what is felt counts from when the force has to be back.
Event ends_after(Draft& draft, double seconds) {
  draft.hold(seconds + kBack);
  draft.happens();
  draft.hold(0.5);
  return draft.event;
}

// No frame comes for so long under a pressing hand.
Event silent(std::uint64_t seed, double seconds) {
  Draft draft = bare(seed);
  draft.press(draft.place, kUp);
  const double from = draft.now();
  draft.event.fault = [=](DepthFrame& frame) { return !is_within(frame.stamp, from, seconds); };
  return ends_after(draft, seconds);
}

// Nothing is measured in a disc around a pressing hand.
Event hole(std::uint64_t seed, double seconds) {
  Draft draft = bare(seed);
  draft.press(draft.place, kUp);
  const double from = draft.now();
  const double radius = draft.between(0.01, 0.05);
  const Vector3d seen = draft.event.camera.T_world_camera.inverse() * draft.place;
  draft.event.fault = [=](DepthFrame& frame) {
    if (!is_within(frame.stamp, from, seconds)) return true;
    bench::punch_hole(seen, radius, frame);
    return true;
  };
  return ends_after(draft, seconds);
}

// Keeps every second pixel of every second row.
void halve(DepthFrame& frame) {
  CameraModel& camera = frame.camera;
  std::vector<float> depth;
  for (int v = 0; v + 1 < camera.height; v += 2) {
    for (int u = 0; u + 1 < camera.width; u += 2) {
      depth.push_back(frame.depth[static_cast<std::size_t>(v) * camera.width + u]);
    }
  }
  frame.depth = std::move(depth);
  frame.colors.clear();
  camera.width /= 2;
  camera.height /= 2;
  camera.pinhole = {camera.pinhole.fx / 2, camera.pinhole.fy / 2, camera.pinhole.cx / 2,
                    camera.pinhole.cy / 2};
}

Event other_resolution(std::uint64_t seed) {
  Draft draft = bare(seed);
  draft.press(draft.place, kUp);
  const double from = draft.now();
  draft.event.fault = [=](DepthFrame& frame) {
    if (frame.stamp >= from) halve(frame);
    return true;
  };
  return ends_after(draft, 0);
}

// Each frame says that it was taken some millimetres from where it was.
Event unsure_pose(std::uint64_t seed, double sigma) {
  Draft draft = bare(seed);
  const auto random = std::make_shared<Random>(seed);
  draft.event.fault = [=](DepthFrame& frame) {
    const Vector3d off(random->normal(), random->normal(), random->normal());
    frame.T_world_sensor->pretranslate(sigma * off);
    return true;
  };
  draft.press(draft.place, kUp);
  draft.hold(1);
  draft.go(draft.event.hip.back() + 0.06 * draft.level_direction(), 0.03);
  return draft.event;
}

// A fingertip that the camera sees comes up to a pressing hand and goes along 4 mm beside it.
Event finger(std::uint64_t seed, bool seen) {
  constexpr double kTip = 0.008;   // m, radius
  constexpr double kGap = 0.004;   // m, between tip and tool
  constexpr double kFrom = 0.15;   // m, where it comes from
  constexpr double kAlong = 0.08;  // m
  Draft draft = bare(seed);
  draft.press(draft.place, kUp);
  const Vector3d way = draft.level_direction();
  const double turn = draft.one_of({-1., 1.}) * draft.between(60, 120) * std::numbers::pi / 180;
  const Vector3d side = Eigen::AngleAxisd(turn, kUp) * way;
  const double speed = draft.between(0.03, 0.1);
  draft.hold(kFrom / speed);
  if (seen) {
    const Vector3d tip = draft.place + (kTip + kGap) * side + kTip * kUp - kFrom * way;
    draft.event.scene.solids.push_back(
        {{SolidKind::ball, Eigen::Isometry3d(Eigen::Translation3d(tip)), Vector3d::Constant(kTip)},
         {}});
    SimulatedMotion& motion = draft.event.scene.solids.back().motion;
    motion.velocity = speed * way;
    motion.end = draft.now() + kAlong / speed;
    motion.begin = draft.now() - kFrom / speed;
  }
  draft.go(draft.event.hip.back() + kAlong * way, speed);
  draft.hold(0.3);
  return draft.event;
}

enum class Floor { stream, frame, points };

// Slides over a floor as a ToF camera measures it: 10 mm of noise, 9 mm between neighbours in the
// mean of all frames, as a real one had.
Event tof_floor(std::uint64_t seed, Floor kind) {
  Draft draft = bare(seed);
  const double tilt = draft.between(20, 60) * std::numbers::pi / 180;
  draft.look_from(draft.between(1, 2) * Vector3d(-std::sin(tilt), 0, std::cos(tilt)));
  draft.event.camera.noise.silhouettes = false;
  draft.event.camera.noise.model.coefficients = {0.01, 0, 0};
  draft.event.camera.noise.pattern = 0.009 / std::numbers::sqrt2;
  if (kind == Floor::frame) draft.event.camera.frames = 1;
  if (kind == Floor::points) {
    draft.event.as_points = true;
    draft.event.camera.rate = 5;  // Hz, what preparation keeps up with
  }
  const Vector3d way = draft.level_direction();
  draft.press(draft.place - 0.2 * way, kUp);
  draft.go(draft.event.hip.back() + 0.4 * way, 0.05);
  return draft.event;
}

}  // namespace

std::vector<Row> fault_rows() {
  using Seed = std::uint64_t;
  std::vector<Row> rows;
  for (const double seconds : {0.1, 0.5, 1., 5.}) {
    rows.push_back(
        {fmt::format("silent for {} s", seconds), [=](Seed s) { return silent(s, seconds); }});
    rows.push_back(
        {fmt::format("a hole for {} s", seconds), [=](Seed s) { return hole(s, seconds); }});
  }
  rows.push_back({"half the resolution", other_resolution});
  for (const double mm : {1., 3.}) {
    rows.push_back({fmt::format("poses that are {} mm off", mm),
                    [=](Seed s) { return unsure_pose(s, 1e-3 * mm); }});
  }
  rows.push_back({"no finger beside the tool", [](Seed s) { return finger(s, false); }});
  rows.push_back({"a finger beside the tool", [](Seed s) { return finger(s, true); }});
  rows.push_back({"ToF floor", [](Seed s) { return tof_floor(s, Floor::stream); }});
  rows.push_back({"ToF floor, one frame", [](Seed s) { return tof_floor(s, Floor::frame); }});
  rows.push_back({"ToF floor as points", [](Seed s) { return tof_floor(s, Floor::points); }});
  return rows;
}

}  // namespace palpate::events
