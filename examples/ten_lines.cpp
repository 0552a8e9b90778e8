#include <cstdio>
#include <palpate/palpate.hpp>

int main(int, char** arguments) {
  palpate::Scene scene;
  scene.add("scan", palpate::read_cloud(arguments[1]));  // prepares here; throws palpate::Error
  palpate::SceneField field(scene);
  palpate::Proxy proxy({.stiffness = 500});                          // N/m
  for (double t = 0; t < 1; t += 1e-3) {                             // your own loop, at 1 kHz
    const Eigen::Vector3d hand(0, 0, 0.05 - 0.06 * t);               // m, from your device
    field.update(t, hand, proxy.position());                         // wait-free
    const palpate::Contact contact = proxy.step(field, hand, 1e-3);  // noexcept, no allocation
    if (contact.touching) std::printf("%.3f s: %.2f N\n", t, contact.force.norm());
  }
}
