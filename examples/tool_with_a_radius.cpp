// A point and a ball of 3 mm slide over the same bumps. The proxy is the middle of the ball and
// stays 3 mm away from the surface, so the ball feels valleys narrower than the point does.
#include <cstdio>
#include <palpate/palpate.hpp>

namespace {

void slide(palpate::Scene& scene, const char* name, double tool_radius) {
  palpate::SceneField field(scene, {.tool_radius = tool_radius});
  palpate::Proxy proxy;
  for (int step = 0; step < 2000; ++step) {
    // m: begins above, then presses with 1 N
    const double height = proxy.has_begun() ? proxy.position().z() - 2e-3 : 0.03;
    const Eigen::Vector3d hand(9e-5 * step - 0.09, 0, height);
    field.update(1e-3 * step, hand, proxy);
    const palpate::Contact contact = proxy.step(field, hand, 1e-3);
    if (step % 10 != 0 || !contact.touching) continue;
    std::printf("%s %.1f mm: %.2f mm\n", name, 1e3 * contact.proxy.x(), 1e3 * contact.proxy.z());
  }
}

}  // namespace

int main() {
  const double radius = 3e-3;  // m
  palpate::SourceOptions options;
  options.prepare.minimum_radius = radius / 0.3;  // the surface is as smooth as that tool needs
  palpate::Scene scene;
  scene.add("bumps", palpate::synthetic_cloud("bumps"), options);
  slide(scene, "point", 0);
  slide(scene, "ball", radius);
}
