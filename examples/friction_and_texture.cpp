// One stroke over one surface that is smooth, has friction, or has a fine relief.
#include <cstdio>
#include <palpate/palpate.hpp>

namespace {

void stroke(palpate::Scene& scene, const char* name, const palpate::ProxyOptions& options) {
  palpate::SceneField field(scene);
  palpate::Proxy proxy(options);
  for (int step = 0; step < 1000; ++step) {
    const double t = 1e-3 * step;                                             // s
    const Eigen::Vector3d hand(0.04 * t - 0.02, 0, t < 0.02 ? 0.02 : -2e-3);  // 2 mm deep
    field.update(t, hand, proxy);
    const palpate::Contact contact = proxy.step(field, hand, 1e-3);
    if (step % 5 == 0 && contact.touching) {
      const double backward = 0.0 - contact.force.x();
      std::printf("%s %.1f mm: %.3f N\n", name, 1e3 * hand.x(), backward);
    }
  }
}

}  // namespace

int main() {
  palpate::PointCloud plate;  // 8 cm wide, a point every 2 mm
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) plate.positions.emplace_back(2e-3f * i, 2e-3f * j, 0.0f);
  }
  palpate::Scene scene;
  scene.add("plate", plate);
  stroke(scene, "smooth", {});
  stroke(scene, "friction",
         {.friction = {.static_coefficient = 0.5, .dynamic_coefficient = 0.3, .viscous = 0}});
  stroke(scene, "texture", {.texture = {.amplitude = 1e-4, .wavelength = 4e-3}});  // m
}
