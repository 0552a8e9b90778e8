// Plays an event: one simulated camera, its source, a field and a proxy.
#include "accuracy/truth_frame.hpp"
#include "events/event.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::events {
namespace {

void push(const Event& event, DepthFrame frame, const Source::StartTime& start, Source& source) {
  if (event.fault && !event.fault(frame)) return;
  if (event.as_points) {
    source.push(accuracy::back_project(frame), frame.stamp, start);
  } else {
    source.push(frame, start);
  }
}

}  // namespace

Felt play(const Event& event) {
  SimulatedCamera camera(event.scene, event.camera);
  Scene scene;
  Source& source = scene.add("camera", {.T_world_sensor = event.camera.T_world_camera});
  SimulatedStream stream(
      camera, "camera",
      [&](const DepthFrame& frame, const Source::StartTime& start) {
        push(event, frame, start, source);
      },
      {.latency = 0.01, .lead = 0.002}, [&] { source.keep(); });
  SceneField field(scene);
  Proxy proxy({.stiffness = kK});
  Felt felt;
  for (std::size_t i = 0; i < event.hip.size(); ++i) {
    const double now = static_cast<double>(i) * kTick;
    stream.advance(now);
    field.update(now, event.hip[i], proxy);
    const Contact contact = proxy.step(field, event.hip[i], kTick);
    felt.force.push_back(contact.force);
    felt.proxy.push_back(contact.proxy);
    felt.touching.push_back(contact.touching);
  }
  return felt;
}

}  // namespace palpate::events
