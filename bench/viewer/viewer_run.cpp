// Runs a servo beside a viewer with clients.
#include "viewer/viewer_run.hpp"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "clouds.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::viewer_bench {

namespace {

constexpr const char* kToken = "bench";
// judgement: 10 Hz, faster than clouds are sent
constexpr std::chrono::milliseconds kRenewal(100);

void show(Source& source, std::shared_ptr<const SurfacePoints> points, double now) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->start = snapshot->end = now;
  snapshot->layers.push_back({.points = std::move(points)});
  source.publish(std::move(snapshot));
}

/// Shows the same points again and again, as if a sensor had seen them anew.
std::jthread renew(Source& source, const WaitingClock& clock) {
  return std::jthread([&source, &clock](const std::stop_token& stop) {
    const auto first = source.points();
    const auto second = std::make_shared<const SurfacePoints>(*first);
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    for (bool odd = true; !stop.stop_requested(); odd = !odd) {
      show(source, odd ? second : first, clock.now());
      never.wait_for(lock, stop, kRenewal, [] { return false; });
    }
  });
}

}  // namespace

void add_cloud(Scene& scene, std::size_t count) {
  PointCloud cloud;
  cloud.positions = bench::bumpy_sphere(count);
  scene.add("cloud").set(cloud);
}

RunResult run_servo(Scene& scene, const Trajectory& hand, Beside beside, WaitingClock& clock,
                    std::optional<int> processor) {
  RunResult result;
  servo_cost::PacedServo servo(scene, hand, clock);
  std::jthread renewing;
  if (beside.renewed) renewing = renew(scene.source(0), clock);
  if (!beside.clients) {
    result.servo = servo.run(processor);
    return result;
  }
  ViewerOptions options;
  options.port = 0;
  options.token = kToken;
  auto viewer = std::make_unique<Viewer>(scene, std::vector<Servo*>{&servo.servo()}, options);
  Watching watching(viewer->port(), kToken);
  result.servo = servo.run(processor);
  watching.wait_for_clouds();
  result.counts = viewer->counts();
  viewer.reset();
  result.clients = watching.reports();
  return result;
}

}  // namespace palpate::viewer_bench
