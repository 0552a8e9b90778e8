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

// What the force is worth, as a stretched spring's. Forces act a while after they were computed, so
// what counts is the most that it held since those were that act now.
class HeldEnergy {
 public:
  explicit HeldEnergy(int delay) : held_(static_cast<std::size_t>(delay) + 2, 0.0) {}

  // A step's, J at the hand; `scale`: of the workspace. Of a force that fades after its surface has
  // gone: as the spring that made it.
  [[nodiscard]] double of(const ServoState& state, double scale) {
    if (state.contact.stiffness > 0) stiffness_ = scale * state.contact.stiffness;
    const double force = std::max(state.force.norm(), state.contact.force.norm());
    held_.pop_front();
    held_.push_back(stiffness_ > 0 ? force * force / (2 * stiffness_) : 0);
    return std::ranges::max(held_);
  }

 private:
  std::deque<double> held_;
  double stiffness_ = 0;  // N/m at the hand
};

// The most that is given from any moment of a contact to a later one, beyond what the spring held.
class FromAnyMoment {
 public:
  // Nothing is touched: `given` so far, J.
  void begin(double given) { least_ = given; }
  void add(double given, double held) {
    least_ = std::min(least_, given + held);
    most_ = std::max(most_, given - least_);
  }
  [[nodiscard]] double most() const { return most_; }

 private:
  double least_ = 0;
  double most_ = 0;
};

}  // namespace

GivenEnergy given_energy(SimulatedDevice& device, Scene& scene, const ServoOptions& options,
                         int steps, const std::function<void(double)>& prepare) {
  Servo servo(device, scene, options);
  const int delay = static_cast<int>(std::lround(*device.info().delay * device.info().rate));
  SurfaceWork surface(delay);
  GivenEnergy given;
  FromAnyMoment from_any;
  HeldEnergy held(delay);
  double begun = 0;  // J, when the present contact began
  int free_steps = 0;
  for (int i = 0; i < steps && !has_ended(servo.state().device); ++i) {
    if (prepare) prepare(i / device.info().rate);
    const ServoState& state = servo.tick();
    const Vector3d drift = state.contact.drift / options.workspace.scale;
    surface.add(options.workspace.force_to_device(state.force),
                options.workspace.T_world_device.linear().transpose() * Vector3d(state.dt * drift));
    const double work = device.work() - surface.now();
    given.in_all = std::max(given.in_all, work);
    given.in_a_contact = std::max(given.in_a_contact, work - begun);
    from_any.add(work, held.of(state, options.workspace.scale));
    given.largest_force = std::max(given.largest_force, state.force.norm());
    free_steps = state.force.isZero(0) ? free_steps + 1 : 0;
    if (free_steps == delay + 2) ++given.contacts;
    if (free_steps <= delay + 1) continue;
    begun = work;
    from_any.begin(work);
  }
  given.beyond_the_spring = from_any.most();
  given.counts = servo.state().guard.counts;
  return given;
}

}  // namespace palpate::test
