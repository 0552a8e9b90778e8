// Sets up scenes, cameras and paths of the experiments.
#include "streams/stream_setup.hpp"

#include <cmath>
#include <numbers>

#include "accuracy/rows.hpp"

namespace palpate::streams {
namespace {

using accuracy::Path;
using accuracy::PathBuilder;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;  // rad
constexpr double kPressDepth = 0.003;               // m
constexpr double kComingDepth = 0.025;              // m
constexpr double kWarmUp = 0.5;                     // s, in which filters over time fill
constexpr double kSettle = 0.5;                     // s

SimulatedCameraOptions camera_at(const Isometry3d& pose, const Frames& frames) {
  SimulatedCameraOptions camera;
  camera.T_world_camera = pose;
  camera.noise.kind = frames.noise;
  camera.noise.seed = frames.seed;
  camera.noise.silhouettes = frames.silhouettes;
  camera.jitter = frames.jitter;
  return camera;
}

// The path, after the hand has waited where it begins.
Path delayed(const Path& path, double seconds) {
  const auto ticks = static_cast<std::size_t>(std::lround(seconds / kTick));
  Path out = path;
  out.hip.insert(out.hip.begin(), ticks, path.hip.front());
  out.begin += ticks;
  out.end += ticks;
  return out;
}

Setup at_table(const Frames& frames) {
  const SimulatedTable table = make_simulated_table();
  Setup setup;
  setup.scene = table.scene;
  setup.cameras = {camera_at(table.T_world_camera, frames)};
  return setup;
}

Path press(const Vector3d& place, const Vector3d& out, double seconds) {
  return delayed(PathBuilder(place + 0.01 * out)
                     .line_to(place - kPressDepth * out)
                     .hold(kSettle)
                     .start_score()
                     .hold(seconds)
                     .build(),
                 kWarmUp);
}

// Presses `kComingDepth` into the surface while it rests, then moves with it.
void ride(Setup& setup, const Vector3d& place, const Vector3d& out, double seconds) {
  PathBuilder builder(place + 0.01 * out);
  builder.line_to(place - kComingDepth * out).hold(0.2);
  setup.rest = delayed(builder.build(), kWarmUp).hip.size() - 1;
  const Vector3d deep = place - kComingDepth * out;
  const double speed = setup.speed;
  builder.line_to(deep + kSettle * speed * out, speed)
      .start_score()
      .line_to(deep + (kSettle + seconds) * speed * out, speed);
  setup.path = delayed(builder.build(), kWarmUp);
  setup.depth = kComingDepth;
}

SimulatedMotion coming(const Setup& setup, const Vector3d& out) {
  SimulatedMotion motion;
  motion.velocity = setup.speed * out;
  motion.begin = static_cast<double>(setup.rest) * kTick;
  return motion;
}

}  // namespace

Setup static_press(const Frames& frames) {
  Setup setup = at_table(frames);
  const SimulatedTable table = make_simulated_table();
  setup.path = press(table.free_patch, Vector3d::UnitZ(), frames.seconds);
  setup.depth = kPressDepth;
  return setup;
}

Setup sphere_slide(const Frames& frames, int arc) {
  Setup setup = at_table(frames);
  const auto row = accuracy::make_rows(accuracy::make_truth_scene())[2];
  setup.path = delayed(row.paths.at(static_cast<std::size_t>(arc)), kWarmUp);
  setup.depth = kPressDepth;
  return setup;
}

Setup plane_comes(const Frames& frames, double speed) {
  Setup setup = at_table(frames);
  const SimulatedTable table = make_simulated_table();
  // The table alone: it must not run into what stands on it.
  setup.scene.solids.resize(1);
  setup.speed = speed;
  ride(setup, table.free_patch, Vector3d::UnitZ(), frames.seconds);
  setup.scene.solids[0].motion = coming(setup, Vector3d::UnitZ());
  return setup;
}

Setup ball_comes(const Frames& frames, double speed) {
  Setup setup;
  setup.cameras = {camera_at(Isometry3d::Identity(), frames)};
  constexpr double kBall = 0.060;  // m
  constexpr double kFront = 0.75;  // of its nearest point, m
  const Vector3d out = -Vector3d::UnitZ();
  Solid ball{SolidKind::ball, Isometry3d::Identity(), Vector3d::Constant(kBall)};
  ball.T_world_solid.translation() = Vector3d(0, 0, kFront + kBall);
  Solid wall;
  wall.T_world_solid.linear() =
      Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  wall.T_world_solid.translation() = Vector3d(0, 0, 1.2);
  setup.speed = speed;
  ride(setup, Vector3d(0, 0, kFront), out, frames.seconds);
  setup.scene.solids = {{wall, {}}, {ball, coming(setup, out)}};
  return setup;
}

Setup camera_moves(const Frames& frames) {
  Setup setup = static_press(frames);
  SimulatedMotion& motion = setup.cameras[0].motion;
  motion.frequency = 0.25;
  const double rate = 2 * std::numbers::pi * motion.frequency;
  motion.swing = Vector3d(0, 0.05 / rate, 0);
  motion.rock = 10 * kDegree / rate;
  return setup;
}

Setup two_cameras(const Frames& frames, int part) {
  Setup setup = at_table(frames);
  const accuracy::TruthScene truth = accuracy::make_truth_scene();
  const auto rows = accuracy::make_rows(truth);
  // plane slide across the camera; sphere slide across.
  setup.path = delayed(part == 0 ? rows[0].paths[2] : rows[2].paths[0], kWarmUp);
  const Isometry3d turn(Eigen::AngleAxisd(60 * kDegree, Vector3d::UnitZ()));
  Frames others = frames;
  others.seed += 1000;
  SimulatedCameraOptions second = camera_at(turn * setup.cameras[0].T_world_camera, others);
  second.phase = 0.011;
  second.T_camera_reported = calibration_error(0.003, 0.5 * kDegree, frames.seed);
  setup.cameras.push_back(second);
  setup.depth = kPressDepth;
  return setup;
}

}  // namespace palpate::streams
