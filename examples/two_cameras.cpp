// Two depth cameras see one scene from two sides and make one surface. A hand goes around a ball:
// where one camera cannot see it, the other holds the hand. This is in simulated time; with real
// cameras a palpate::Stream for each takes the place of SimulatedStream (touch_a_camera.cpp).
#include <cmath>
#include <cstdio>
#include <palpate/palpate.hpp>
#include <palpate/sensor/depth_camera.hpp>
#include <palpate/sensor/stream.hpp>

int main() {
  palpate::Scene scene;
  palpate::Source& left = scene.add("left");
  palpate::Source& right = scene.add("right");
  const auto left_camera = palpate::open_camera("simulated:left");
  const auto right_camera = palpate::open_camera("simulated:right");
  palpate::SimulatedStream left_stream(*left_camera, left);
  palpate::SimulatedStream right_stream(*right_camera, right);

  const Eigen::Vector3d ball(0.02, 0.24, 0.06);  // the middle of the simulated scene's ball, m
  palpate::SceneField field(scene);
  palpate::Proxy proxy({.stiffness = 500});  // N/m
  for (int step = 0; step < 2000; ++step) {
    const double t = 1e-3 * step;  // s
    left_stream.advance(t);        // prepares the frames that have come
    right_stream.advance(t);
    const double angle = 1.7 * std::sin(3 * t);      // rad, from where both see it
    const double distance = t < 0.2 ? 0.08 : 0.057;  // m: first outside, then 3 mm deep
    const Eigen::Vector3d hand =
        ball + distance * Eigen::Vector3d(-std::cos(angle), -std::sin(angle), 0);
    field.update(t, hand, proxy);
    const palpate::Contact contact = proxy.step(field, hand, 1e-3);
    if (step % 10 != 0 || !contact.touching) continue;
    const std::string& camera = scene.source(static_cast<std::size_t>(contact.source)).name();
    std::printf("%s %.0f degrees: %.2f N\n", camera.c_str(), 57.3 * angle, contact.force.norm());
  }
}
