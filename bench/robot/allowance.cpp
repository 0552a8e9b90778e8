// Tells how deep a target may be: three deviations of noise and one frame's motion.
#include "robot/allowance.hpp"

#include <algorithm>

namespace palpate::robot {
namespace {

using Eigen::Vector3d;

constexpr double kNearby = 0.02;      // m; judgement: what is as near to the tool does not hide it
constexpr double kRim = 5;            // pixels; judgement: windows there are cut
constexpr double kDeviations = 3;     // of noise; derived: docs/ros2.md allows as many
constexpr double kStep = 1e-3;        // m; judgement: less than a deviation of the noise
constexpr double kThickest = 0.5;     // m; derived: twice 0.25 m, the longest rise; rays slant
constexpr double kMillimetre = 1e-3;  // m; unit

// The place on the camera's ray where it leaves the solid that holds x; x where none does.
Vector3d surface_before(const Trial& trial, const Vector3d& eye, const Vector3d& x, double t) {
  const Vector3d way = (eye - x).normalized();
  const double end = std::min(kThickest, (eye - x).norm());
  double s = 0;
  while (s < end && distance_and_normal(trial.scene, x + s * way, t).value < 0) s += kStep;
  return x + s * way;
}

// One frame of a camera, s: just before a frame arrives, the newest one is an interval and the
// delay old; longer where one is taken early and the next one late. Lost frames get no more.
double one_frame(const Watcher& watcher) {
  return 1 / watcher.options.rate + 2 * watcher.options.jitter + watcher.delay;
}

bool is_in_picture(const Watcher& watcher, const Vector3d& x, double t) {
  const SimulatedCameraOptions& options = watcher.options;
  const Vector3d seen = moved(options.T_world_camera, options.motion, t).inverse() * x;
  const CameraModel& camera = options.camera;
  const Pinhole& p = camera.pinhole;
  const double u = p.cx + p.fx * seen.x() / seen.z();
  const double v = p.cy + p.fy * seen.y() / seen.z();
  return u >= kRim && v >= kRim && u <= camera.width - kRim && v <= camera.height - kRim;
}

// Does the camera see x, or the surface of what holds x? Its ray may pass as near to other things
// as it likes: what it shows beside them is true.
bool looks_there(const Trial& trial, const Watcher& watcher, const Vector3d& x, double t) {
  const SimulatedCameraOptions& options = watcher.options;
  const Vector3d eye = moved(options.T_world_camera, options.motion, t).translation();
  const Vector3d surface = surface_before(trial, eye, x, t);
  const Vector3d way = eye - surface;
  double room = kStep;
  for (double s = kStep; s < way.norm() && room >= 0; s += std::max(room, kStep))
    room = distance_and_normal(trial.scene, surface + s * way.normalized(), t).value;
  return room >= 0 && is_in_picture(watcher, surface, t);
}

}  // namespace

double depth_at(const Trial& trial, const Vector3d& x, double t) {
  const double distance = distance_and_normal(trial.scene, x, t).value;
  return std::max(trial.tool_radius - distance, 0.0) / kMillimetre;
}

bool is_seen(const Trial& trial, const Watcher& watcher, const Vector3d& x, double t) {
  if (!is_in_picture(watcher, x, t)) return false;
  const SimulatedCameraOptions& options = watcher.options;
  const Vector3d way = moved(options.T_world_camera, options.motion, t).translation() - x;
  for (double s = kNearby; s < way.norm(); s += kNearby / 2) {
    if (distance_and_normal(trial.scene, x + s * way.normalized(), t).value < kNearby / 4)
      return false;
  }
  return true;
}

// Noise and one frame's motion, mm: three deviations of a pixel's depth there, and what the true
// surface moved over the place while one frame (s) of the slowest camera lasted that looked there
// when it began. That is speed (m/s) x frame (s) where the speed is constant, and no more than was
// moved where the surface starts or turns. No camera looked: no motion.
Allowance allowance(const Trial& trial, const Vector3d& x, double t) {
  Allowance allowed;
  for (const Watcher& watcher : trial.cameras) {
    const SimulatedCameraOptions& options = watcher.options;
    const double z = (moved(options.T_world_camera, options.motion, t).inverse() * x).z();
    const double noise = kDeviations * options.noise.model.sigma(z) / kMillimetre;
    allowed.noise = std::max(allowed.noise, noise);
  }
  const double depth = depth_at(trial, x, t);
  allowed.mm = allowed.noise;
  if (depth <= allowed.noise) return allowed;
  for (const Watcher& watcher : trial.cameras) {
    double window = one_frame(watcher);
    while (window > allowed.window && !looks_there(trial, watcher, x, t - window)) window -= kTick;
    allowed.window = std::max(allowed.window, window);
  }
  double least = depth;
  for (double s = 0; s < allowed.window; s += kTick)
    least = std::min(least, depth_at(trial, x, t - s));
  least = std::min(least, depth_at(trial, x, t - allowed.window));
  allowed.mm += depth - least;
  return allowed;
}

}  // namespace palpate::robot
