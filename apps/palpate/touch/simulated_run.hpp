#pragma once

#include "apps/palpate/run/run.hpp"

namespace palpate::app {

/// Cameras, preparation and servo on one simulated clock, one thread, as fast as they go. The same
/// run gives the same steps, bit for bit. One hand, without a guard. Fills in what `loaded` tells
/// of its cameras. False: it was ended by Ctrl-C. @throws Error when the device fails.
bool run_simulated(Run& run, const EachStep& each);

}  // namespace palpate::app
