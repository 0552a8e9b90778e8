// Plays hands on what cameras see, and on the exact solids.
#include <algorithm>
#include <array>
#include <deque>
#include <memory>

#include "eyes/view.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::eyes {
namespace {

constexpr long kArrives = 100;  // ticks before they move, in which fields ask for what they need

/// The solids' union; exact outside, with sharp creases.
class Solids final : public AnalyticField {
 public:
  explicit Solids(const View& view) : AnalyticField({.step_length = 0.004}), scene_(&view.scene) {}

 private:
  [[nodiscard]] Distance distance(const Vector3d& x) const noexcept override {
    return distance_and_normal(*scene_, x, 0);
  }
  const SimulatedScene* scene_;
};

/// One hand's field and proxy.
struct Reader {
  explicit Reader(Scene& scene, const Hand& of)
      : hand(&of), field(scene), proxy({.stiffness = kK}) {}

  /// `tick`: of the hand; it waits where it begins before 0 and where it ends.
  void step(double now, long tick) {
    const long last = static_cast<long>(hand->hip.size()) - 1;
    const Vector3d& hip = hand->hip[static_cast<std::size_t>(std::clamp(tick, 0L, last))];
    const double before = thread_cpu_seconds();
    field.update(now, hip, proxy);
    const Contact contact = proxy.step(field, hip, kTick);
    spent += thread_cpu_seconds() - before;
    if (tick < 0 || tick > last) return;
    felt.force.push_back(contact.force);
    felt.proxy.push_back(contact.proxy);
  }

  const Hand* hand;
  SceneField field;
  Proxy proxy;
  Felt felt;
  double spent = 0;
};

void feel_ideal(const View& view, const Hand& hand, Felt& felt) {
  const Solids solids(view);
  Proxy proxy({.stiffness = kK});
  for (const Vector3d& hip : hand.hip) {
    const Contact contact = proxy.step(solids, hip, kTick);
    felt.ideal.push_back(contact.force);
    felt.ideal_proxy.push_back(contact.proxy);
  }
}

/// In the camera's frame.
PointCloud exact_points(const View& view) {
  const SimulatedCameraOptions& camera = view.cameras.front();
  const Picture picture(view, camera);
  PointCloud cloud;
  if (view.feed == Feed::viewpoint) cloud.viewpoint = Vector3d::Zero();
  for (int v = 0; v < picture.camera.height; v += 2) {
    for (int u = 0; u < picture.camera.width; u += 2) {
      if (!(picture.depth[static_cast<std::size_t>(v) * picture.camera.width + u] > 0)) continue;
      const Vector3d at = picture.point(u, v);
      const Vector3d normal = distance_and_normal(view.scene, at, 0).gradient;
      cloud.positions.push_back((picture.T_camera_world * at).cast<float>());
      cloud.normals.push_back((picture.T_camera_world.linear() * normal).cast<float>());
    }
  }
  return cloud;
}

/// What a camera puts into the scene, tick by tick.
class Feeder {
 public:
  Feeder(const View& view, SimulatedCameraOptions options, const std::string& name, Scene& scene)
      : source_(&scene.add(name, {.T_world_sensor = options.T_world_camera})) {
    if (view.feed == Feed::single) options.frames = 1;
    camera_ = std::make_unique<SimulatedCamera>(view.scene, options);
    stream_ = std::make_unique<SimulatedStream>(
        *camera_, name,
        [this](const DepthFrame& frame, const Source::StartTime& start) {
          source_->push(frame, start);
        },
        SimulatedStreamOptions{.latency = 0.01, .lead = 0.002}, [this] { source_->keep(); });
  }
  void advance(double now) { stream_->advance(now); }

 private:
  Source* source_;
  std::unique_ptr<SimulatedCamera> camera_;
  std::unique_ptr<SimulatedStream> stream_;
};

}  // namespace

std::vector<Felt> play(const View& view, const std::vector<Hand>& hands) {
  Scene scene;
  std::deque<Feeder> feeders;
  if (view.feed == Feed::points || view.feed == Feed::viewpoint) {
    scene.add("camera", {.T_world_sensor = view.cameras.front().T_world_camera})
        .set(exact_points(view));
  } else {
    for (std::size_t k = 0; k < view.cameras.size(); ++k) {
      feeders.emplace_back(view, view.cameras[k], "camera " + std::to_string(k), scene);
    }
  }
  std::deque<Reader> readers;
  long longest = 0;
  for (const Hand& hand : hands) {
    readers.emplace_back(scene, hand);
    longest = std::max(longest, static_cast<long>(hand.hip.size()));
  }
  const auto warm = std::lround(kWarm / kTick);
  for (long tick = -warm; tick < longest; ++tick) {
    const double now = static_cast<double>(tick + warm) * kTick;
    for (Feeder& feeder : feeders) feeder.advance(now);
    if (tick < -kArrives) continue;
    for (Reader& reader : readers) reader.step(now, tick);
  }
  std::vector<Felt> all;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    Felt& felt = readers[k].felt;
    felt.force.resize(hands[k].hip.size(), Vector3d::Zero());
    felt.microseconds = 1e6 * readers[k].spent / static_cast<double>(longest + kArrives);
    feel_ideal(view, hands[k], felt);
    all.push_back(std::move(felt));
  }
  return all;
}

}  // namespace palpate::eyes
