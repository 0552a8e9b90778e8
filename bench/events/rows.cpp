// Rows of things that are hidden, appear, vanish, move fast or end.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "events/event.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

// An arm passes between the camera and a pressed table, which it hides for so long.
void hidden_by_arm(Event& event) {
  event.press(event.place, kUp);
  const Vector3d view = event.to_camera(event.place);
  const double radius = event.between(0.02, 0.045);
  const double hidden = event.one_of({0.1, 0.3, 1.0, 3.0});
  const double speed = std::min(1.5, 2 * radius / hidden);
  const Vector3d way = view.cross(kUp).normalized() * (event.between(0, 1) < 0.5 ? 1 : -1);
  const double length = 2 * radius + 0.2;
  const Vector3d middle = event.place + event.between(0.12, 0.25) * view;
  SimulatedSolid& arm = event.cylinder(middle - 0.5 * length * way, view.cross(way), radius, 0.5);
  Event::moves(arm, speed * way, event.now(), length / speed);
  event.hold(length / speed + 0.5);
}

// A box is put before it, and stays.
void hidden_by_box(Event& event) {
  event.press(event.place, kUp);
  const Vector3d view = event.to_camera(event.place);
  SimulatedSolid& box = event.block(event.place + event.between(0.1, 0.25) * view, view,
                                    Vector3d::Constant(event.between(0.02, 0.05)));
  Event::comes(box, event.now() + 0.1);
  event.hold(event.one_of({0.5, 1.5, 3.0}));
}

// An arm passes through where the hand rests, pressed to nothing.
void swept(Event& event) {
  const Vector3d hip = event.place + event.between(0.08, 0.16) * kUp;
  event.start(hip);
  event.hold(1);
  event.happens();
  const double radius = event.between(0.02, 0.045);
  const double speed = event.between(0.1, 1);
  const Vector3d way = (event.level_direction() + event.between(-0.3, 0.3) * kUp).normalized();
  const Vector3d aside = way.cross(event.to_camera(hip)).normalized();
  const Vector3d miss = event.between(-0.5, 0.5) * radius * way.cross(aside);
  SimulatedSolid& arm = event.cylinder(hip + miss - 0.2 * way, aside, radius, 0.4);
  Event::moves(arm, speed * way, event.now(), 0.4 / speed);
  event.hold(0.4 / speed + 0.5);
}

void vanishes(Event& event) {
  const double half = event.between(0.02, 0.04);
  SimulatedSolid& box = event.block(event.place + half * kUp, kUp, Vector3d::Constant(half));
  event.press(event.place + 2 * half * kUp, kUp);
  event.depth = 0;
  Event::goes(box, event.now() + event.between(0.05, 0.1));
  event.hold(1.2);
}

// A face appears so far before (> 0) or behind where a hand rests in the air.
void appears(Event& event, double before) {
  const Vector3d hip = event.place + event.between(0.1, 0.16) * kUp;
  event.start(hip);
  event.hold(1);
  event.happens();
  const Vector3d view = event.to_camera(hip);
  const double half = event.between(0.02, 0.04);
  SimulatedSolid& box = event.block(hip + (before - half) * view, view, Vector3d::Constant(half));
  Event::comes(box, event.now() + event.between(0.05, 0.1));
  event.hold(1.5);
}

// The same before a surface that the hand presses.
void appears_on(Event& event, double before) {
  event.press(event.place, kUp);
  SimulatedSolid& box =
      event.block(event.place + (before - 0.1) * kUp, kUp, Vector3d(0.04, 0.04, 0.1));
  Event::comes(box, event.now() + event.between(0.05, 0.1));
  event.depth = kPress;
  event.hold(1.5);
}

// The pressed surface goes to and fro along its normal; the hand follows the surface that is felt.
void to_and_fro(Event& event, double speed, bool ball) {
  constexpr double kDepth = 0.01;  // m; judgement
  event.camera.rate = event.one_of({15, 30, 60, 90});
  const double swing = std::min(0.1, 0.3 * speed);
  const Vector3d place(event.place.x(), event.place.y(), 0);
  const Vector3d out = ball ? event.to_camera(place) : kUp;
  auto& solids = event.scene.solids;
  event.clear();
  if (ball) {
    const double radius = event.between(0.06, 0.15);
    solids[0].solid.T_world_solid.translation() = -2 * kUp;
    event.add(SolidKind::ball, place - radius * out, Vector3d::Constant(radius));
  }
  SimulatedMotion& motion = solids.back().motion;
  motion.frequency = speed / (2 * std::numbers::pi * swing);
  motion.swing = swing * out;
  motion.phase = event.between(0, 6);
  // A surface is felt 10 ms after its frame was taken, and is there a frame later.
  const double lag = 0.01 + 1 / event.camera.rate;
  const auto seconds = 1.6 + std::clamp(2 / motion.frequency, 1.0, 4.0);
  for (double t = 0; t < seconds; t += kTick) {
    const double height =
        swing * std::sin(2 * std::numbers::pi * motion.frequency * (t - lag) + motion.phase);
    const double depth = std::clamp(0.1 * (t - 0.6), -0.02, kDepth);
    event.hip.emplace_back(place + (height - depth) * out);
  }
  event.begin = 1000;
  event.depth = kDepth;
}

// From behind a plate that the camera sees from the front, out, and then onto it.
void from_behind(Event& event) {
  const Vector3d middle = event.place + event.between(0.1, 0.16) * kUp;
  const Vector3d out = event.to_camera(middle);
  event.block(middle - 0.003 * out, out, Vector3d(0.05, 0.05, 0.003));
  event.start(middle - 0.05 * out);
  event.hold(0.6);
  event.happens();
  event.go(middle + 0.03 * out, event.between(0.03, 0.15));
}

// The same, and back again: then it holds.
void back_again(Event& event) {
  from_behind(event);
  const Vector3d middle = event.scene.solids.back().solid.T_world_solid.translation();
  const Vector3d out = event.to_camera(middle);
  event.go(middle + (0.003 - kPress) * out, 0.05);
  event.hold(0.3);
  event.happens();
  event.hold(0.5);
  event.depth = kPress;
}

// After the last of some frames the hand goes where it has not been.
void ended(Event& event, int frames) {
  event.camera.frames = frames;
  event.camera.noise.model.coefficients = {event.between(0.001, 0.006), 0, 0};
  event.start(event.place + 0.05 * kUp);
  event.hold(frames / 30.0 + 0.5);
  for (int i = 0; i < 4; ++i) {
    const Vector3d next(event.between(-0.12, 0.12), event.between(-0.15, 0.15), 0);
    event.go(next + 0.02 * kUp, 0.2);
    event.go(next - kPress * kUp, 0.05);
    event.hold(0.1);
    if (i == 0) event.happens();
    event.go(next + 0.04 * event.level_direction() - kPress * kUp, 0.05);
    event.go(event.hip.back() + 0.02 * kUp, 0.1);
  }
  event.depth = kPress;
  event.when_deep = true;
}

}  // namespace

std::vector<Row> plain_rows() {
  std::vector<Row> rows = {{"hidden by an arm", hidden_by_arm},
                           {"hidden by a box", hidden_by_box},
                           {"an arm sweeps over a hand", swept},
                           {"vanishes", vanishes}};
  for (const double mm : {30., 15., 5., -5., -15., -30.}) {
    rows.push_back({fmt::format("appears {} mm before a hand", mm),
                    [mm](Event& e) { appears(e, 1e-3 * mm); }});
  }
  for (const double mm : {30., 15., 5.}) {
    rows.push_back({fmt::format("appears {} mm over a pressed table", mm),
                    [mm](Event& e) { appears_on(e, 1e-3 * mm); }});
  }
  for (const double speed : {0.02, 0.1, 0.3, 0.5, 1.0}) {
    for (const bool ball : {false, true}) {
      rows.push_back({fmt::format("{} to and fro at {} m/s", ball ? "ball" : "plane", speed),
                      [=](Event& e) { to_and_fro(e, speed, ball); }});
    }
  }
  rows.push_back({"from behind a plate", from_behind});
  rows.push_back({"and back onto it", back_again});
  for (const int frames : {1, 3, 30}) {
    rows.push_back(
        {fmt::format("ended after {} frames", frames), [=](Event& e) { ended(e, frames); }});
  }
  return rows;
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  for (const auto& some :
       {plain_rows(), sensor_rows(), hidden_rows(), hostile_rows(), fault_rows()}) {
    rows.insert(rows.end(), some.begin(), some.end());
  }
  return rows;
}

}  // namespace palpate::events
