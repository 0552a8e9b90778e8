// Rows that nobody arranges for: other sensors and rates, things that touch the table at the hand,
// cameras that look away, places that are hidden when a hand comes to them.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "events/event.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

using Change = std::function<void(Event&)>;

void set(Event& event, const std::vector<std::string>& assignments) {
  SimulatedSetup setup;
  setup.camera = event.camera;
  for (const std::string& assignment : assignments) set_simulated(setup, assignment);
  event.camera = setup.camera;
}

Change keys(std::vector<std::string> assignments) {
  return [=](Event& event) { set(event, assignments); };
}

// Something thin or thick passes between the camera and a pressed table.
void passes(Event& event, double low, double high, const Change& change) {
  change(event);
  event.press(event.place, kUp);
  const Vector3d view = event.to_camera(event.place);
  const double radius = event.between(low, high);
  const Vector3d way = view.cross(kUp).normalized() * (event.between(0, 1) < 0.5 ? 1 : -1);
  const double length = 2 * radius + 0.2;
  const Vector3d middle = event.place + event.between(0.04, 0.2) * view;
  const double speed = event.between(0.1, 1);
  Event::moves(event.cylinder(middle - 0.5 * length * way, view.cross(way), radius, 0.5),
               speed * way, event.now(), length / speed);
  event.hold(length / speed + 1);
}

// An arm is put onto a table beside a hand or on it, and is lifted again.
void lowered(Event& event, double aside) {
  constexpr double kHeight = 0.06;  // m, half of the way; judgement: well above the hand
  event.press(event.place, kUp);
  const Vector3d side = event.level_direction();
  const double radius = event.between(0.02, 0.045);
  const double speed = event.between(0.05, 0.3);
  const Vector3d at = event.place + (aside > 0 ? radius + aside : 0.0) * side;
  SimulatedSolid& arm =
      event.cylinder(at + (radius + 0.002 + kHeight) * kUp, kUp.cross(side), radius, 0.3);
  arm.motion.swing = kHeight * kUp;
  arm.motion.frequency = speed / (2 * std::numbers::pi * kHeight);
  arm.motion.phase =
      std::numbers::pi / 2 - 2 * std::numbers::pi * arm.motion.frequency * event.now();
  Event::comes(arm, event.now());
  event.hold(1 / arm.motion.frequency + 0.5);
}

// A box is pushed over a pressed table, past the hand so far away, or through it.
void pushed(Event& event, double gap) {
  event.press(event.place, kUp);
  const double half = event.between(0.015, 0.03);
  const double speed = event.between(0.05, 0.4);
  const Vector3d way = event.level_direction();
  const double miss = gap < 0 ? 0 : half + gap;
  const double length = 0.3;
  SimulatedSolid& box =
      event.block(event.place + half * kUp - 0.5 * length * way + miss * way.cross(kUp), kUp,
                  Vector3d::Constant(half));
  box.solid.T_world_solid.linear().col(0) = way;
  box.solid.T_world_solid.linear().col(1) = kUp.cross(way);
  Event::moves(box, speed * way, event.now(), length / speed);
  event.hold(length / speed + 1.5);
}

// A hand goes to and fro over the boundary of what a box hides of a table.
void along_shadow(Event& event, const Change& change) {
  change(event);
  event.press(event.place, kUp);
  const Vector3d view = event.to_camera(event.place);
  const Vector3d side = view.cross(kUp).normalized();
  const double half = event.between(0.02, 0.05);
  SimulatedSolid& box = event.block(event.place + event.between(0.08, 0.2) * view + half * side,
                                    view, Vector3d::Constant(half));
  Event::comes(box, event.now());
  event.hold(0.3);
  const Vector3d at = event.hip.back();
  for (int i = 0; i < 3; ++i) {
    event.go(at + 0.02 * event.level_direction(), 0.05);
    event.go(at, 0.1);
  }
}

// A hand comes to a place that was seen, and is hidden by now.
void into_shadow(Event& event) {
  const Vector3d view = event.to_camera(event.place);
  SimulatedSolid& box =
      event.block(event.place + event.between(0.15, 0.25) * view, view, Vector3d::Constant(0.04));
  Event::comes(box, 1);
  event.start(event.place + Vector3d(0, 0.15, 0.03));
  event.hold(event.one_of({1.5, 3.0, 8.0}));
  event.happens();
  event.go(event.place + 0.02 * kUp, 0.2);
  event.go(event.place - kPress * kUp, 0.05);
  event.hold(0.5);
  event.depth = kPress;
  event.when_deep = true;
}

// A camera pans away from what is pressed and back.
void pans(Event& event, bool error) {
  constexpr double kError = 0.002;  // m, and 1/3 degree; judgement: a usual calibration
  if (error) event.camera.T_camera_reported = calibration_error(kError, kDegree / 3, event.seed);
  SimulatedMotion& motion = event.camera.motion;
  motion.frequency = event.between(0.08, 0.12);
  motion.rock = event.between(0.6, 0.7);
  motion.axis = Vector3d::UnitZ();
  event.press(event.place, kUp);
  motion.phase = -2 * std::numbers::pi * motion.frequency * event.now();
  event.hold(0.55 / motion.frequency);
}

// A resting hand on a still table as another sensor sees it.
void rests(Event& event, const Change& change) {
  change(event);
  event.press(event.place, kUp);
  event.hold(3);
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
          {"75 degrees", [](Event& e) { e.look_from(75 * kDegree, 0.8); }},
          {"from 0.3 m",
           [](Event& e) {
             e.look_from(40 * kDegree, 0.36);
             e.place *= 0.3;
           }},
          {"from 3 m", [](Event& e) {
             e.clear();
             e.look_from(40 * kDegree, 3);
           }}};
}

}  // namespace

std::vector<Row> hostile_rows() {
  const Change none = [](Event&) {};
  std::vector<Row> rows;
  const auto add = [&rows](const std::string& name, auto make) { rows.push_back({name, make}); };
  for (const auto& [name, change] : ways()) {
    add("rests, " + name, [=](Event& e) { rests(e, change); });
    add("arm passes, " + name, [=](Event& e) { passes(e, 0.02, 0.045, change); });
    add("cable passes, " + name, [=](Event& e) { passes(e, 0.002, 0.005, change); });
    add("along a shadow, " + name, [=](Event& e) { along_shadow(e, change); });
  }
  add("cable passes", [=](Event& e) { passes(e, 0.002, 0.005, none); });
  add("along a shadow", [=](Event& e) { along_shadow(e, none); });
  for (const double mm : {0., 5., 15., 30.}) {
    add(fmt::format("an arm is lowered {} mm beside a hand", mm),
        [=](Event& e) { lowered(e, 1e-3 * mm); });
  }
  for (const double mm : {-1., 3., 10., 25.}) {
    add(fmt::format("a box is pushed past a hand at {} mm", mm),
        [=](Event& e) { pushed(e, 1e-3 * mm); });
  }
  add("into a shadow", into_shadow);
  add("camera pans", [](Event& e) { pans(e, false); });
  add("camera pans, pose 2 mm off", [](Event& e) { pans(e, true); });
  return rows;
}

}  // namespace palpate::events
