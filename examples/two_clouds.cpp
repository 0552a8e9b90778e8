// Two clouds at once, each with a pose of its own: a hand slides from one onto the other.
#include <cstdio>
#include <palpate/palpate.hpp>

namespace {

using Eigen::Vector3d;

// A square plate of 10 cm, seen from above.
palpate::PointCloud plate() {
  palpate::PointCloud cloud;
  for (int i = -25; i <= 25; ++i) {
    for (int j = -25; j <= 25; ++j) cloud.positions.emplace_back(2e-3f * i, 2e-3f * j, 0.0f);
  }
  cloud.viewpoint = Vector3d(0, 0, 1);
  return cloud;
}

palpate::SourceOptions placed_at(const Vector3d& place) {
  palpate::SourceOptions options;
  options.T_world_sensor.translation() = place;
  return options;
}

}  // namespace

int main() {
  palpate::Scene scene;
  scene.add("left", plate(), placed_at({-0.045, 0, 0}));
  scene.add("right", plate(), placed_at({0.045, 0, 0.002}));

  palpate::SceneField field(scene);
  palpate::Proxy proxy;
  int touched = -2;
  for (int step = 0; step < 2000; ++step) {
    const double t = step * 1e-3;                                       // s
    const Vector3d hand(-0.08 + 0.08 * t, 0, t < 0.1 ? 0.05 : -0.003);  // m
    field.update(t, hand, proxy);
    const palpate::Contact contact = proxy.step(field, hand, 1e-3);
    if (contact.source != touched) {
      touched = contact.source;
      const char* name =
          touched < 0 ? "nothing" : scene.source(static_cast<std::size_t>(touched)).name().c_str();
      std::printf("%.3f s: touching %s, %.2f N\n", t, name, contact.force.norm());
    }
  }
  return touched == 1 ? 0 : 1;
}
