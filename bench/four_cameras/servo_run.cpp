// Runs a servo beside cameras, or beside surfaces that move or rest.
#include "four_cameras/servo_run.hpp"

#include <algorithm>
#include <deque>
#include <optional>

#include "palpate/sensor/stream.hpp"

namespace palpate::four_cameras {

namespace {

constexpr double kLongest = 3600;  // s; judgement: a moving surface moves all the while
constexpr float kShift = 1e-4F;    // m, over that time; judgement: too little to be felt
constexpr double kWarm = 1;        // s that cameras run before the servo does; judgement: 30 frames

// Frames of one camera that became touchable: when they were taken, and from when on they are felt.
struct Lane {
  Source* source = nullptr;
  std::vector<std::array<double, 2>> felt;
  std::optional<Stream> stream;

  void take(const DepthFrame& frame, const Source::StartTime& start) {
    double from = 0;
    source->push(frame, [&] { return from = start(); });
    felt.push_back({from, frame.stamp});
  }
};

std::deque<Lane> start_cameras(CameraRig& rig, Scene& scene, const Clock& clock) {
  std::deque<Lane> lanes(kCameras);
  for (int k = 0; k < kCameras; ++k) {
    Lane& lane = lanes[static_cast<std::size_t>(k)];
    lane.source = &scene.source(static_cast<std::size_t>(k));
    lane.stream.emplace(
        rig.camera(k), lane.source->name(),
        [&lane](const DepthFrame& frame, const Source::StartTime& start) {
          lane.take(frame, start);
        },
        clock);
  }
  return lanes;
}

void set_in_motion(Scene& scene, double now) {
  for (std::size_t i = 0; i < scene.size(); ++i) {
    auto points = std::make_shared<SurfacePoints>(*scene.source(i).points());
    points->end_positions.assign(points->grid.points().begin(), points->grid.points().end());
    for (auto& position : points->end_positions) position.z() += kShift;
    points->end_normals = points->normals;
    points->end_density_weights = points->density_weights;
    finish(*points);
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->start = now;
    snapshot->end = now + kLongest;
    snapshot->layers.push_back({.points = std::move(points)});
    scene.source(i).publish(std::move(snapshot));
  }
}

std::vector<double> ages(const std::deque<Lane>& lanes, double start, double end) {
  std::vector<double> all;
  for (const Lane& lane : lanes) {
    std::size_t next = 0;
    for (double t = start; t < end; t += 1 / servo_cost::kServoRate) {
      while (next < lane.felt.size() && lane.felt[next][0] <= t) ++next;
      if (next > 0) all.push_back(t - lane.felt[next - 1][1]);
    }
  }
  return all;
}

}  // namespace

RunResult run_servo(CameraRig& rig, const Trajectory& hand, Beside beside, WaitingClock& clock,
                    std::optional<int> processor) {
  Scene scene;
  CameraRig::add_sources(scene);
  std::deque<Lane> lanes = start_cameras(rig, scene, clock);
  clock.wait_until(clock.now() + kWarm);
  if (beside != Beside::cameras) {
    lanes.clear();
    for (std::size_t i = 0; i < scene.size(); ++i) scene.source(i).keep();
  }
  if (beside == Beside::moving) set_in_motion(scene, clock.now());
  servo_cost::PacedServo servo(scene, hand, clock);
  RunResult result;
  const double start = clock.now();
  result.servo = servo.run(processor);
  result.ages = ages(lanes, start, clock.now());
  std::ranges::sort(result.ages);
  for (const Lane& lane : lanes) result.streams.push_back(lane.stream->state());
  lanes.clear();
  return result;
}

}  // namespace palpate::four_cameras
