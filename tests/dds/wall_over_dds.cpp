// A wall felt through a device that another process owns: wall_over_dds SECONDS FACTOR. Opens
// ros:fd, whose node is hand_node, and renders a plane at z = 0 with FACTOR times the stiffness
// that Colgate and Schenkel's condition gives for the measured delay and the damping in the
// environment variable DAMPING, without a guard. Prints both.
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "palpate/device/hardware.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "palpate/servo/z_width.hpp"

int main(int count, char** arguments) {
  using namespace palpate;
  if (count != 3) return 2;
  const double seconds = std::stod(arguments[1]);
  const double damping = std::stod(std::getenv("DAMPING"));
  SteadyClock clock;
  const auto device = open_device("ros:fd,profile=omega", clock);
  const DeviceInfo& info = device->info();
  const double stiffness =
      std::stod(arguments[2]) * passive_stiffness(damping, 1 / info.rate, *info.delay);
  PointCloud plane;
  for (int i = -60; i <= 60; ++i) {
    for (int k = -60; k <= 60; ++k)
      plane.positions.emplace_back(1e-3F * static_cast<float>(i), 1e-3F * static_cast<float>(k),
                                   0.0F);
  }
  Scene scene;
  scene.add("plane", plane, {});
  ServoOptions options;
  options.guard.on = false;
  options.proxy.stiffness = stiffness;
  Servo servo(*device, scene, options);
  const ServoThread thread(servo, clock, {}, 1000);
  fmt::print("rate {:.1f} Hz, delay {:.2f} ms, stiffness {:.0f} N/m\n", info.rate,
             1e3 * *info.delay, stiffness);
  const double start = clock.now();
  clock.wait_until(start + seconds);
  fmt::print("device {}: {}\n", servo.state().device == DeviceState::Status::ok ? "ok" : "not ok",
             device->reason());
}
