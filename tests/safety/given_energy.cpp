#include "safety/given_energy.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// What the surface did while a force acted that was sent `delay` steps before.
class SurfaceWork {
 public:
  explicit SurfaceWork(int delay)
      : forces_(static_cast<std::size_t>(delay) + 1, Vector3d::Zero()) {}

  [[nodiscard]] double now() const { return work_; }

  // A step: what was sent before acts over the way of the surface since then.
  void add(const Vector3d& force, const Vector3d& surface_way) {
    work_ += forces_.front().dot(surface_way);
    forces_.pop_front();
    forces_.push_back(force);
  }

 private:
  std::deque<Vector3d> forces_;
  double work_ = 0;
};

}  // namespace

GivenEnergy given_energy(SimulatedDevice& device, Scene& scene, const ServoOptions& options,
                         int steps, const std::function<void(double)>& prepare) {
  Servo servo(device, scene, options);
  const int delay = static_cast<int>(std::lround(*device.info().delay * device.info().rate));
  SurfaceWork surface(delay);
  GivenEnergy given;
  double begun = 0;  // J, when the present contact began
  int free_steps = 0;
  for (int i = 0; i < steps && !has_ended(servo.state().device); ++i) {
    if (prepare) prepare(i / device.info().rate);
    const ServoState& state = servo.tick();
    const Vector3d drift = state.contact.drift / options.workspace.scale;
    surface.add(servo.device_force(),
                options.workspace.T_world_device.linear().transpose() * Vector3d(state.dt * drift));
    const double work = device.work() - surface.now();
    given.in_all = std::max(given.in_all, work);
    given.in_a_contact = std::max(given.in_a_contact, work - begun);
    given.largest_force = std::max(given.largest_force, state.force.norm());
    free_steps = state.force.isZero(0) ? free_steps + 1 : 0;
    if (free_steps == delay + 2) ++given.contacts;
    if (free_steps > delay + 1) begun = work;
  }
  given.counts = servo.state().guard.counts;
  return given;
}

}  // namespace palpate::test
