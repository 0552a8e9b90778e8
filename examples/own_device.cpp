// A device of your own: here one that moves into a ball and out again, and ends after two seconds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <palpate/device/device.hpp>
#include <palpate/palpate.hpp>
#include <palpate/servo/servo_thread.hpp>

namespace {

class Prodding final : public palpate::Device {
 public:
  explicit Prodding(const palpate::Clock& clock) : clock_(clock), begin_(clock.now()) {
    info_.name = "prodding";
    info_.maximum_force = 10;  // N; without it no force is sent
    info_.rate = 1000;         // Hz
  }

  const palpate::DeviceInfo& info() const noexcept override { return info_; }

  palpate::DeviceState read() noexcept override {  // never waits, throws or allocates
    const double t = clock_.now() - begin_;        // s
    const double speed = t < 1 ? -0.05 : 0.05;     // m/s
    palpate::DeviceState state;
    state.time = t;
    state.position = {0, 0, t < 1 ? 0.09 + speed * t : 0.04 + speed * (t - 1)};
    state.velocity = {0, 0, speed};
    if (t > 2) state.status = palpate::DeviceState::Status::finished;  // ends the loop
    return state;
  }

  void write(const Eigen::Vector3d& force) noexcept override {  // N, to your motors
    largest_ = std::max(largest_, force.norm());
  }

  std::string reason() const override { return {}; }  // of a status `failed`
  double largest() const { return largest_; }

 private:
  const palpate::Clock& clock_;
  double begin_;
  palpate::DeviceInfo info_;
  double largest_ = 0;
};

}  // namespace

int main() {
  palpate::SteadyClock clock;
  palpate::Scene scene;
  scene.add("ball", palpate::synthetic_cloud("sphere"));
  Prodding device(clock);
  palpate::ServoState::Queue steps(4096);  // every step comes here; the servo waits for nobody
  palpate::Servo servo(device, scene, {.steps = &steps});
  palpate::ServoThread thread(servo, clock);
  while (thread.running()) {
    clock.wait_until(clock.now() + 0.1);
    while (const auto step = steps.pop()) {  // a log would be written here
      if (step->step % 10 != 0) continue;
      std::printf("%.1f mm: %.2f N\n", 1e3 * step->hip.z(), step->force.norm());
    }
  }
  thread.stop();
  std::printf("largest force %.2f N in %llu steps\n", device.largest(),
              static_cast<unsigned long long>(servo.state().step));
}
