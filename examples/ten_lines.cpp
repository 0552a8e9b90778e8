#include <cstdio>
#include <palpate/palpate.hpp>

int main() {
  palpate::Scene scene;
  scene.add("ball", palpate::synthetic_cloud("sphere"));  // or read_cloud("scan.ply"): prepares it
  palpate::SceneField field(scene);
  palpate::Proxy proxy({.stiffness = 500});                          // N/m
  for (double t = 0; t < 1; t += 1e-3) {                             // your own loop, at 1 kHz
    const Eigen::Vector3d hand(0, 0, 0.08 - 0.06 * t);               // m, from your device
    field.update(t, hand, proxy);                                    // wait-free
    const palpate::Contact contact = proxy.step(field, hand, 1e-3);  // noexcept, no allocation
    if (contact.touching) std::printf("%.3f s: %.2f N\n", t, contact.force.norm());
  }
}
