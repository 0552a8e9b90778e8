// A box is held askew and pressed onto a floor: first a corner touches and turns it, then it lies
// flat. The hand feels a force and a torque.
#include <cstdio>
#include <memory>
#include <palpate/field/analytic.hpp>
#include <palpate/tool/tool_proxy.hpp>

int main() {
  const palpate::PlaneField floor;  // z = 0
  const auto box = std::make_shared<const palpate::Tool>(
      palpate::Tool::from_text("box:40x60x20", 5e-3));  // mm; samples at most 5 mm apart
  palpate::ToolProxy proxy(box, {.stiffness = 500});    // N/m; that of turns follows from the box
  palpate::Pose hand;
  hand.orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 0.5, 0).normalized());
  for (int step = 0; step < 1000; ++step) {
    hand.position.z() = 0.02 - 2e-5 * step;  // m, of the box's middle
    const palpate::ToolContact contact = proxy.step(floor, hand, 1e-3);
    if (step % 100 != 0 || !contact.touching) continue;
    std::printf("%5.1f mm: %.2f N, %.3f N m, tilted by %.3f rad\n", 1e3 * hand.position.z(),
                contact.wrench.force.norm(), contact.wrench.torque.norm(),
                contact.proxy.orientation.angularDistance(Eigen::Quaterniond::Identity()));
  }
}
