// Touches a plane of points through the installed headers and libraries: both targets, one object
// of each kind. Fails unless the plane pushes back.
#include <palpate/device/simulated.hpp>
#include <palpate/palpate.hpp>

int main() {
  palpate::PointCloud cloud;
  for (int x = -15; x <= 15; ++x) {
    for (int y = -15; y <= 15; ++y) cloud.positions.emplace_back(4e-3f * x, 4e-3f * y, 0.0f);
  }
  cloud.viewpoint = Eigen::Vector3d(0, 0, 1);
  palpate::Scene scene;
  scene.add("plane", cloud);

  palpate::SceneField field(scene);
  palpate::Proxy proxy;
  palpate::ScriptedDevice device(
      {{0.000, {0, 0, 0.05}}, {0.001, {0, 0, 0}}, {0.002, {0, 0, -5e-3}}});
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const palpate::DeviceState hand = device.read();
    field.update(hand.time, hand.position, proxy);
    force = proxy.step(field, hand.position, 1e-3).force;
    device.write(force);
  }
  return force.z() > 1 && device.force() == force ? 0 : 1;
}
