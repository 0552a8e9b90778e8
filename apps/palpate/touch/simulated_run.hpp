#pragma once

#include <functional>

#include "apps/palpate/run/run.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/workspace.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate::app {

/// Cameras, preparation and servo on one simulated clock, one thread, as fast as they go. The same
/// run gives the same steps, bit for bit. One hand. Fills in what `touched` tells of its cameras.
/// False: it was ended by Ctrl-C. @throws Error when the device fails.
bool run_simulated(Run& run, const EachStep& each);

/// Steps a device, a field and a proxy together in the device's time until the device is finished,
/// and hands every step to `each`; calls `before` with each step's time (s) before it, to bring the
/// scene there or, by false, to end the run. Computing time is update() and step() alone.
/// @throws Error when the device fails.
void run_touch(Device& device, const Workspace& workspace, SceneField& field, Proxy& proxy,
               const std::function<bool(double)>& before,
               const std::function<void(const TouchStep&)>& each);

/// The same over a scene that stands still.
void run_touch(Device& device, const Workspace& workspace, SceneField& field, Proxy& proxy,
               const std::function<void(const TouchStep&)>& each);

}  // namespace palpate::app
