// Touches what a camera sees: threads of a Stream feed the scene while this one steps the hand.
//
//   touch_a_camera openni2
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <palpate/palpate.hpp>
#include <palpate/sensor/depth_camera.hpp>
#include <palpate/sensor/stream.hpp>
#include <thread>

namespace {

using Eigen::Vector3d;
using std::chrono::steady_clock;

// A point in the middle of what is seen, and a place well in front of it.
struct Way {
  Vector3d place;
  Vector3d outside;
};

Way way_to(const palpate::SurfacePoints& points) {
  const Eigen::Vector3f center = (points.bounds().center() - points.origin).cast<float>();
  std::vector<palpate::CellGrid::Neighbor> found;
  points.grid.nearest(center, 1, found);
  const auto index = found.front().index;
  const Vector3d place = points.origin + points.grid.points()[index].cast<double>();
  return {place, place + 8 * points.radius * points.normals[index].cast<double>()};
}

void touch(const char* name) {
  const palpate::SteadyClock clock;
  palpate::Scene scene;
  palpate::Source& source = scene.add("camera");
  palpate::SceneField field(scene);
  const auto camera = palpate::open_camera(name, {.clock = &clock});
  const palpate::Stream stream(*camera, source, clock);

  for (int i = 0; i < 500 && !source.points(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (!source.points()) throw palpate::Error("no frame arrived: " + stream.state().problem);
  const Way way = way_to(*source.points());
  palpate::Proxy proxy({.stiffness = 500});  // N/m
  double largest = 0;                        // N
  auto next = steady_clock::now();
  for (int step = 0; step < 1500; ++step) {  // 1 kHz; a device's callback would be better
    std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
    const double done = std::min(1.0, 1e-3 * step);
    const Vector3d hand = way.outside + 1.05 * done * (way.place - way.outside);
    field.update(clock.now(), hand, proxy);
    const double force = proxy.step(field, hand, 1e-3).force.norm();
    largest = std::max(largest, force);
    if (step % 10 == 0) std::printf("%.3f s: %.3f N\n", 1e-3 * step, force);
  }
  const palpate::StreamState state = stream.state();
  std::printf("%s: %.1f frames per second, touchable after %.1f ms; largest force %.3f N\n",
              state.camera.c_str(), state.rate, 1e3 * state.latency_mean, largest);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    touch(count > 1 ? arguments[1] : "simulated");
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
