// A box is held askew and pressed onto a floor that a formula gives: first a corner touches and
// turns it, then it lies flat. Then a gripper closes around the tube of a scanned torus. The hand
// feels a force, a torque, and what presses the gripper open.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <palpate/field/analytic.hpp>
#include <palpate/io/synthetic.hpp>
#include <palpate/scene/scene.hpp>
#include <palpate/tool/tool_field.hpp>
#include <palpate/tool/tool_proxy.hpp>

using palpate::Pose;
using palpate::Tool;
using palpate::ToolContact;

namespace {

void press_a_box() {
  const palpate::PlaneField floor;  // z = 0
  // mm; samples at most 5 mm apart
  const auto box = std::make_shared<const Tool>(Tool::from_text("box:40x60x20", 5e-3));
  palpate::ToolProxy proxy(box, {.stiffness = 500});  // N/m; that of turns follows from the box
  Pose hand;
  hand.orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 0.5, 0).normalized());
  for (int step = 0; step < 1000; ++step) {
    hand.position.z() = 0.02 - 2e-5 * step;  // m, of the box's middle
    const ToolContact contact = proxy.step(floor, hand, 1e-3);
    if (step % 100 != 0 || !contact.touching) continue;
    std::printf("%5.1f mm: %.2f N, %.3f N m, tilted by %.3f rad\n", 1e3 * hand.position.z(),
                contact.wrench.force.norm(), contact.wrench.torque.norm(),
                contact.proxy.orientation.angularDistance(Eigen::Quaterniond::Identity()));
  }
}

void grip_a_torus() {
  palpate::Scene scene;
  scene.add("torus", palpate::synthetic_cloud("torus"));
  const double spacing = 0.5 * scene.source(0).points()->radius;  // half of R, or less
  const auto gripper = std::make_shared<const Tool>(Tool::from_text("gripper:6x12x50", spacing));
  palpate::ToolField field(scene, gripper);  // what each group of samples sees of the scene
  palpate::ToolProxy proxy(gripper);
  Pose hand;
  hand.opening = 0.07;
  hand.position = {0.07, 0, 0.07};  // the fingers point down and open along x
  for (int step = 0; step < 2000; ++step) {
    hand.position.z() = std::max(0.03, 0.07 - 1e-4 * step);
    if (step > 500) hand.opening = std::max(0.02, hand.opening - 5e-5);
    field.update(1e-3 * step, hand, proxy);  // s
    const ToolContact contact = proxy.step(field, hand, 1e-3);
    if (step % 200 != 0) continue;
    std::printf("hand %4.1f mm, gripper %4.1f mm open: grip %.2f N, %d touches\n",
                1e3 * hand.opening, 1e3 * contact.proxy.opening, contact.wrench.grip,
                contact.touch_count);
  }
}

}  // namespace

int main() {
  press_a_box();
  grip_a_torus();
}
