#pragma once

#include <memory>

#include "apps/palpate/options/chosen_source.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

/// Opens the camera or recording that `source` names. Its frames come as they happen on `clock`,
/// which outlives it, or as fast as they are asked for without one; its poses, where it tells any,
/// are put where the user wants them.
/// @throws Error when it is not there or, without a clock, cannot do but keep its own time.
[[nodiscard]] std::unique_ptr<DepthCamera> open_live(const ChosenSource& source,
                                                     const Clock* clock);

/// The same at its own pace where it has one, else as fast as it is asked.
[[nodiscard]] std::unique_ptr<DepthCamera> open_live_at_any_pace(const ChosenSource& source);

/// The next frame of use, waiting for some seconds at most.
/// @throws Error that names the camera and what it complained of.
[[nodiscard]] DepthFrame first_frame(DepthCamera& camera);

}  // namespace palpate::app
