#pragma once

#include <string>

#include "sim/simulated_camera.hpp"

namespace palpate {

/// Changes a set-up by "KEY=VALUE" (open_simulated() says which there are).
/// @throws Error when the key is unknown or the value makes no sense.
void set_simulated(SimulatedSetup& setup, const std::string& assignment);

}  // namespace palpate
