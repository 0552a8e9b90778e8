#include "apps/palpate/touch/touch_run.hpp"

#include <fmt/format.h>

#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

void run_touch(Device& device, const Workspace& workspace, SceneField& field, Proxy& proxy,
               const std::function<bool(double)>& before,
               const std::function<void(const TouchStep&)>& each) {
  double previous = 0;
  bool first = true;
  while (true) {
    const DeviceState state = device.read();
    if (state.status == DeviceStatus::finished) return;
    if (state.status == DeviceStatus::failed) {
      throw Error(fmt::format("device '{}' failed: {}", device.info().name, device.reason()));
    }
    if (!before(state.time)) return;
    const double dt = first ? 1 / device.info().rate : state.time - previous;
    TouchStep step;
    step.time = state.time;
    step.hip = workspace.position_to_world(state.position);
    const double start = thread_cpu_seconds();
    field.update(state.time, step.hip, first ? step.hip : proxy.position());
    step.contact = proxy.step(field, step.hip, dt);
    step.microseconds = 1e6 * (thread_cpu_seconds() - start);
    step.patch_points = field.patch_points();
    step.notes = field.notes();
    device.write(workspace.force_to_device(step.contact.force));
    each(step);
    previous = state.time;
    first = false;
  }
}

void run_touch(Device& device, const Workspace& workspace, SceneField& field, Proxy& proxy,
               const std::function<void(const TouchStep&)>& each) {
  run_touch(
      device, workspace, field, proxy, [](double) { return true; }, each);
}

}  // namespace palpate::app
