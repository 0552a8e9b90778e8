#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "events/draft.hpp"
#include "events/rows.hpp"
#include "sim/simulated_camera.hpp"

// What nobody arranges for: other sensors and rates, what touches the table at the hand, cameras
// that look away, regions that are hidden when a hand comes to them.

namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

using Change = std::function<void(Draft&)>;

void set(Draft& draft, const std::vector<std::string>& assignments) {
  SimulatedSetup setup;
  setup.camera = draft.event.camera;
  for (const std::string& assignment : assignments) set_simulated(setup, assignment);
  draft.event.camera = setup.camera;
}

Change keys(std::vector<std::string> assignments) {
  return [=](Draft& draft) { set(draft, assignments); };
}

void look_from(Draft& draft, double degrees, double far) {
  const double tilt = degrees * kDegree;
  draft.look_from(far * Vector3d(-std::sin(tilt), 0, std::cos(tilt)));
}

void passing(Draft& draft, SimulatedSolid& solid, const Vector3d& way, double length,
             double speed) {
  solid.motion.velocity = speed * way;
  solid.motion.begin = draft.now();
  solid.motion.end = draft.now() + length / speed;
}

// Something thin or thick passes between the camera and a pressed table.
Event passes(std::uint64_t seed, double low, double high, const Change& change) {
  Draft draft(seed);
  change(draft);
  draft.press(draft.place, kUp);
  const Vector3d view = draft.to_camera(draft.place);
  const double radius = draft.between(low, high);
  const Vector3d way = view.cross(kUp).normalized() * (draft.between(0, 1) < 0.5 ? 1 : -1);
  const double length = 2 * radius + 0.2;
  const Vector3d middle = draft.place + draft.between(0.04, 0.2) * view;
  const double speed = draft.between(0.1, 1);
  passing(draft, draft.cylinder(middle - 0.5 * length * way, view.cross(way), radius, 0.5), way,
          length, speed);
  draft.hold(length / speed + 1);
  return draft.event;
}

// An arm is put onto a table beside a hand or on it, and is lifted again.
Event lowered(std::uint64_t seed, double aside) {
  constexpr double kHeight = 0.06;  // m, half of the way
  Draft draft(seed);
  draft.press(draft.place, kUp);
  const Vector3d side = draft.level_direction();
  const double radius = draft.between(0.02, 0.045);
  const double speed = draft.between(0.05, 0.3);
  const Vector3d at = draft.place + (aside > 0 ? radius + aside : 0.0) * side;
  SimulatedSolid& arm =
      draft.cylinder(at + (radius + 0.002 + kHeight) * kUp, kUp.cross(side), radius, 0.3);
  arm.motion.swing = kHeight * kUp;
  arm.motion.frequency = speed / (2 * std::numbers::pi * kHeight);
  arm.motion.phase =
      std::numbers::pi / 2 - 2 * std::numbers::pi * arm.motion.frequency * draft.now();
  Draft::comes(arm, draft.now());
  draft.hold(1 / arm.motion.frequency + 0.5);
  return draft.event;
}

// A box is pushed over a pressed table, past the hand so far away, or through it.
Event pushed(std::uint64_t seed, double gap) {
  Draft draft(seed);
  draft.press(draft.place, kUp);
  const double half = draft.between(0.015, 0.03);
  const double speed = draft.between(0.05, 0.4);
  const Vector3d way = draft.level_direction();
  const double miss = gap < 0 ? 0 : half + gap;
  const double length = 0.3;
  SimulatedSolid& box =
      draft.block(draft.place + half * kUp - 0.5 * length * way + miss * way.cross(kUp), kUp,
                  Vector3d::Constant(half));
  box.solid.T_world_solid.linear().col(0) = way;
  box.solid.T_world_solid.linear().col(1) = kUp.cross(way);
  passing(draft, box, way, length, speed);
  draft.hold(length / speed + 1.5);
  return draft.event;
}

// A hand goes to and fro over the boundary of what a box hides of a table.
Event along_shadow(std::uint64_t seed, const Change& change) {
  Draft draft(seed);
  change(draft);
  draft.press(draft.place, kUp);
  const Vector3d view = draft.to_camera(draft.place);
  const Vector3d side = view.cross(kUp).normalized();
  const double half = draft.between(0.02, 0.05);
  SimulatedSolid& box = draft.block(draft.place + draft.between(0.08, 0.2) * view + half * side,
                                    view, Vector3d::Constant(half));
  Draft::comes(box, draft.now());
  draft.hold(0.3);
  const Vector3d at = draft.event.hip.back();
  for (int i = 0; i < 3; ++i) {
    draft.go(at + 0.02 * draft.level_direction(), 0.05);
    draft.go(at, 0.1);
  }
  return draft.event;
}

// A hand comes to a place that was seen, and is hidden by now.
Event into_shadow(std::uint64_t seed) {
  Draft draft(seed);
  const Vector3d view = draft.to_camera(draft.place);
  SimulatedSolid& box =
      draft.block(draft.place + draft.between(0.15, 0.25) * view, view, Vector3d::Constant(0.04));
  Draft::comes(box, 1);
  draft.start(draft.place + Vector3d(0, 0.15, 0.03));
  draft.hold(draft.one_of({1.5, 3.0, 8.0}));
  draft.happens();
  draft.go(draft.place + 0.02 * kUp, 0.2);
  draft.go(draft.place - kPress * kUp, 0.05);
  draft.hold(0.5);
  draft.event.depth = kPress;
  draft.event.when_deep = true;
  return draft.event;
}

// A camera pans away from what is pressed and back.
Event pans(std::uint64_t seed, bool error) {
  constexpr double kError = 0.002;  // m, and 1/3 degree
  Draft draft(seed);
  if (error) draft.event.camera.T_camera_told = calibration_error(kError, kDegree / 3, seed);
  SimulatedMotion& motion = draft.event.camera.motion;
  motion.frequency = draft.between(0.08, 0.12);
  motion.rock = draft.between(0.6, 0.7);
  motion.axis = Vector3d::UnitZ();
  draft.press(draft.place, kUp);
  motion.phase = -2 * std::numbers::pi * motion.frequency * draft.now();
  draft.hold(0.55 / motion.frequency);
  return draft.event;
}

// A resting hand on a still table as another sensor sees it.
Event rests(std::uint64_t seed, const Change& change) {
  Draft draft(seed);
  change(draft);
  draft.press(draft.place, kUp);
  draft.hold(3);
  return draft.event;
}

// Other sensors, rates and views.
std::vector<std::pair<std::string, Change>> ways() {
  return {{"structured", keys({"noise=structured"})},
          {"stereo", keys({"noise=stereo"})},
          {"tof", keys({"noise=tof"})},
          {"holes", keys({"holes=0.1"})},
          {"many holes", keys({"holes=0.4"})},
          {"curl", keys({"curl=0.01"})},
          {"terraces", keys({"terraces=0.5"})},
          {"mixed", keys({"mixed=1"})},
          {"15 Hz", keys({"rate=15"})},
          {"90 Hz, jitter", keys({"rate=90", "jitter=0.005"})},
          {"30 % dropped", keys({"dropped=0.3"})},
          {"15 Hz, 50 % dropped", keys({"rate=15", "dropped=0.5"})},
          {"320 wide", keys({"width=320"})},
          {"1280 wide", keys({"width=1280"})},
          {"75 degrees", [](Draft& d) { look_from(d, 75, 0.8); }},
          {"from 0.3 m",
           [](Draft& d) {
             look_from(d, 40, 0.36);
             d.place *= 0.3;
           }},
          {"from 3 m", [](Draft& d) {
             d.event.scene.solids.resize(1);
             look_from(d, 40, 3);
           }}};
}

}  // namespace

std::vector<Row> hostile_rows() {
  const Change none = [](Draft&) {};
  std::vector<Row> rows;
  const auto add = [&rows](const std::string& name, auto make) { rows.push_back({name, make}); };
  using Seed = std::uint64_t;
  for (const auto& [name, change] : ways()) {
    add("rests, " + name, [=](Seed seed) { return rests(seed, change); });
    add("arm passes, " + name, [=](Seed seed) { return passes(seed, 0.02, 0.045, change); });
    add("cable passes, " + name, [=](Seed seed) { return passes(seed, 0.002, 0.005, change); });
    add("along a shadow, " + name, [=](Seed seed) { return along_shadow(seed, change); });
  }
  add("cable passes", [=](Seed seed) { return passes(seed, 0.002, 0.005, none); });
  add("along a shadow", [=](Seed seed) { return along_shadow(seed, none); });
  for (const double mm : {0., 5., 15., 30.}) {
    add(fmt::format("an arm is lowered {} mm beside a hand", mm),
        [=](Seed seed) { return lowered(seed, 1e-3 * mm); });
  }
  for (const double mm : {-1., 3., 10., 25.}) {
    add(fmt::format("a box is pushed past a hand at {} mm", mm),
        [=](Seed seed) { return pushed(seed, 1e-3 * mm); });
  }
  add("into a shadow", into_shadow);
  add("camera pans", [](Seed seed) { return pans(seed, false); });
  add("camera pans, pose 2 mm off", [](Seed seed) { return pans(seed, true); });
  return rows;
}

}  // namespace palpate::events
