#pragma once

#include <memory>
#include <string>
#include <vector>

#include "palpate/sensor/simulated_camera.hpp"

namespace palpate {

/// A scene with a camera that looks at it.
struct SimulatedSetup {
  SimulatedScene scene;
  SimulatedCameraOptions camera;
};

struct SimulatedName {
  std::string name;
  std::string description;  ///< a line for lists
};

/// The scenes that have names.
[[nodiscard]] std::vector<SimulatedName> simulated_names();

/// @throws Error when there is no scene of that name; says which there are.
[[nodiscard]] SimulatedSetup make_simulated_setup(const std::string& name);

/// Opens "SCENE[,KEY=VALUE]..." ("" is the scene `table`). Keys: noise (none, a, b, c: NoiseKind in
/// their order; structured, stereo, tof: what such sensors do in all, before other keys of noise),
/// sigma (m, at all depths), terraces (SimulatedNoiseOptions::disparity_step), curl, mixed,
/// pattern, holes, seed, silhouettes (0, 1), rate (Hz), phase (s), jitter (s), dropped, repeat
/// (shares), jump (s), frames, loop, tilt (degrees between the middle ray and the vertical, 0-90),
/// view (degrees that the camera stands round the scene's vertical), width (pixels; the height
/// follows), error (of the pose that it tells, m, with 1/6 degree for each millimetre; after
/// `seed`). Cameras on one clock see one world at one time. `clock` outlives the camera; null:
/// frames come as fast as they are asked for, from the scene's time 0 on.
/// @throws Error when a name or a value makes no sense.
[[nodiscard]] std::unique_ptr<SimulatedCamera> open_simulated(const std::string& specification,
                                                              const Clock* clock);

}  // namespace palpate
