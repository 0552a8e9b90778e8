// Touches a file with a haptic device: touch_with_a_device forcedimension bunny.ply
#include <cstdio>
#include <palpate/device/hardware.hpp>
#include <palpate/palpate.hpp>
#include <palpate/servo/servo_thread.hpp>

int main(int count, char** arguments) try {
  if (count != 3) return std::puts("usage: touch_with_a_device DEVICE CLOUD");
  palpate::SteadyClock clock;
  const auto device = palpate::open_device(arguments[1], clock);
  palpate::Scene scene;
  const auto points = scene.add("cloud", palpate::read_cloud(arguments[2])).points();
  palpate::ServoOptions options{.guard = {.maximum_force = 3}};  // N
  options.workspace.T_world_device.translation() = points->bounds().center();
  palpate::Servo servo(*device, scene, options);  // the guard is in it
  palpate::ServoThread thread(servo, clock);
  std::puts("Move the device; the enter key ends.");
  std::getchar();
  thread.stop();  // zero force
  std::printf("%llu steps\n", static_cast<unsigned long long>(servo.state().step));
} catch (const palpate::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
