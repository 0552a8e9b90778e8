#pragma once

#include <functional>
#include <vector>

#include "apps/palpate/run/hand.hpp"
#include "apps/palpate/run/touch_statistics.hpp"
#include "apps/palpate/sources/touched.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {

/// All that a run is made of: what is touched, and who touches.
struct Run {
  const TouchOptions& options;
  Touched& touched;
  Scene& felt;  ///< what the run feels of it: fill_felt()
  std::vector<Hand>& hands;
  FieldOptions field;
  ProxyOptions proxy;
};

/// Is handed every step of every hand, by its index, as soon as it is done.
using EachStep = std::function<void(std::size_t hand, const TouchStep&)>;

/// Cameras, preparation and servo on one simulated clock, one thread, as fast as they go. The same
/// run gives the same steps, bit for bit. One hand. Fills in what `touched` tells of its cameras.
/// False: it was ended by Ctrl-C. @throws Error when the device fails.
bool run_simulated(Run& run, const EachStep& each);

}  // namespace palpate::app
