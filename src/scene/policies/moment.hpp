#pragma once

namespace palpate {

/// When a snapshot holds.
struct Moment {
  double stamp = 0;     ///< of the data that are new in it, s, the sensor's clock
  double start = 0;     ///< s, on the fields' clock; no earlier than the last snapshot's
  double duration = 0;  ///< how long the next one is going to be waited for, s
};

}  // namespace palpate
