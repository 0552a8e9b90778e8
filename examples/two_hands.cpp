// Two hands on one ball, each with a servo and a thread of its own. Here both are simulated
// devices whose hands press and let go; open_device() gives real ones.
#include <cstdio>
#include <palpate/device/simulated.hpp>
#include <palpate/palpate.hpp>
#include <palpate/servo/servo_thread.hpp>

namespace {

// A device in real time, the servo that renders the scene to it, and the thread that steps it.
struct Hand {
  Hand(palpate::Scene& scene, palpate::WaitingClock& clock, double x, double stiffness)
      : mass({}, {{0, {x, 0, 0}}, {1, {0.7 * x, 0, 0}}, {2, {0.7 * x, 0, 0}}, {3, {x, 0, 0}}}),
        device(mass, clock),
        servo(device, scene, {.proxy = {.stiffness = stiffness}}),
        thread(servo, clock) {}

  palpate::SimulatedDevice mass;
  palpate::PacedDevice device;
  palpate::Servo servo;
  palpate::ServoThread thread;
};

}  // namespace

int main() {
  palpate::SteadyClock clock;
  palpate::Scene scene;
  scene.add("ball", palpate::synthetic_cloud("sphere"));  // 12 cm wide
  Hand left(scene, clock, -0.07, 500);                    // m; N/m
  Hand right(scene, clock, 0.07, 200);
  const double start = clock.now();
  while (left.thread.running() && right.thread.running()) {
    clock.wait_until(clock.now() + 0.05);
    const double t = clock.now() - start;
    std::printf("left %.2f s: %.2f N\n", t, left.servo.state().force.norm());
    std::printf("right %.2f s: %.2f N\n", t, right.servo.state().force.norm());
  }
}
