// A sensor is at fault where a hand presses: it is silent, sees a hole, changes its resolution,
// does not know where it stands, sees the user's own finger, or is a ToF camera before a floor.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "events/event.hpp"
namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kBack = 0.3;  // s in which the force has to be back; judgement

bool is_within(double time, double from, double length) {
  return time >= from && time < from + length;
}

// The fault is over after so long; what is felt counts from when the force has to be back.
void ends_after(Event& event, double seconds) {
  event.hold(seconds + kBack);
  event.happens();
  event.hold(0.5);
}

// No frame comes for so long under a pressing hand.
void silent(Event& event, double seconds) {
  event.clear();
  event.press(event.place, kUp);
  const double from = event.now();
  event.fault = [=](DepthFrame& frame) { return !is_within(frame.stamp, from, seconds); };
  ends_after(event, seconds);
}

// Nothing is measured in a disc around a pressing hand.
void hole(Event& event, double seconds) {
  event.clear();
  event.press(event.place, kUp);
  const double from = event.now();
  const double radius = event.between(0.01, 0.05);
  const Vector3d seen = event.camera.T_world_camera.inverse() * event.place;
  event.fault = [=](DepthFrame& frame) {
    if (!is_within(frame.stamp, from, seconds)) return true;
    bench::punch_hole(seen, radius, frame);
    return true;
  };
  ends_after(event, seconds);
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

void other_resolution(Event& event) {
  event.clear();
  event.press(event.place, kUp);
  const double from = event.now();
  event.fault = [=](DepthFrame& frame) {
    if (frame.stamp >= from) halve(frame);
    return true;
  };
  ends_after(event, 0);
}

// Each frame says that it was taken some millimetres from where it was.
void unsure_pose(Event& event, double sigma) {
  event.clear();
  const auto random = std::make_shared<Random>(event.seed);
  event.fault = [=](DepthFrame& frame) {
    const Vector3d off(random->normal(), random->normal(), random->normal());
    frame.T_world_sensor->pretranslate(sigma * off);
    return true;
  };
  event.press(event.place, kUp);
  event.hold(1);
  event.go(event.hip.back() + 0.06 * event.level_direction(), 0.03);
}

// A fingertip that the camera sees comes up to a pressing hand and goes along 4 mm beside it.
void finger(Event& event, bool seen) {
  constexpr double kTip = 0.008;   // m, radius; judgement: a fingertip
  constexpr double kGap = 0.004;   // m, between tip and tool; judgement: nearly touching
  constexpr double kFrom = 0.15;   // m, where it comes from; judgement: out of reach
  constexpr double kAlong = 0.08;  // m; judgement
  event.clear();
  event.press(event.place, kUp);
  const Vector3d way = event.level_direction();
  const double turn = event.one_of({-1., 1.}) * event.between(60, 120) * std::numbers::pi / 180;
  const Vector3d side = Eigen::AngleAxisd(turn, kUp) * way;
  const double speed = event.between(0.03, 0.1);
  event.hold(kFrom / speed);
  if (seen) {
    const Vector3d tip = event.place + (kTip + kGap) * side + kTip * kUp - kFrom * way;
    SimulatedMotion& motion = event.add(SolidKind::ball, tip, Vector3d::Constant(kTip)).motion;
    motion.velocity = speed * way;
    motion.end = event.now() + kAlong / speed;
    motion.begin = event.now() - kFrom / speed;
  }
  event.go(event.hip.back() + kAlong * way, speed);
  event.hold(0.3);
}

enum class Floor { stream, frame, points };

// Slides over a floor as a ToF camera measures it: 10 mm of noise, 9 mm between neighbours in the
// mean of all frames, as a real one had.
void tof_floor(Event& event, Floor kind) {
  event.clear();
  const double tilt = event.between(20, 60) * std::numbers::pi / 180;
  event.look_from(tilt, event.between(1, 2));
  event.camera.noise.silhouettes = false;
  event.camera.noise.model.coefficients = {0.01, 0, 0};
  event.camera.noise.pattern = 0.009 / std::numbers::sqrt2;
  if (kind == Floor::frame) event.camera.frames = 1;
  if (kind == Floor::points) {
    event.as_points = true;
    event.camera.rate = 5;  // Hz, what preparation keeps up with
  }
  const Vector3d way = event.level_direction();
  event.press(event.place - 0.2 * way, kUp);
  event.go(event.hip.back() + 0.4 * way, 0.05);
}

}  // namespace

std::vector<Row> fault_rows() {
  std::vector<Row> rows;
  for (const double seconds : {0.1, 0.5, 1., 5.}) {
    rows.push_back(
        {fmt::format("silent for {} s", seconds), [=](Event& e) { silent(e, seconds); }});
    rows.push_back({fmt::format("a hole for {} s", seconds), [=](Event& e) { hole(e, seconds); }});
  }
  rows.push_back({"half the resolution", other_resolution});
  for (const double mm : {1., 3.}) {
    rows.push_back({fmt::format("poses that are {} mm off", mm),
                    [=](Event& e) { unsure_pose(e, 1e-3 * mm); }});
  }
  rows.push_back({"no finger beside the tool", [](Event& e) { finger(e, false); }});
  rows.push_back({"a finger beside the tool", [](Event& e) { finger(e, true); }});
  rows.push_back({"ToF floor", [](Event& e) { tof_floor(e, Floor::stream); }});
  rows.push_back({"ToF floor, one frame", [](Event& e) { tof_floor(e, Floor::frame); }});
  rows.push_back({"ToF floor as points", [](Event& e) { tof_floor(e, Floor::points); }});
  return rows;
}

}  // namespace palpate::events
