#pragma once

#include <vector>

#include "apps/palpate/sources/touched.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::app {

/// The streams of everything in `touched` that lives, into its sources in `felt`; all outlive it.
class LiveFeed {
 public:
  /// Recordings begin together at `start`, s on the clock.
  LiveFeed(Touched& touched, Scene& felt, const Clock& clock, double start);

  /// How each stream fares, in the order of the sources.
  [[nodiscard]] std::vector<StreamState> states() const;

  /// Ends the streams and puts what they were like into `touched`, times counted from the start.
  void finish();

 private:
  Touched& touched_;
  Scene& felt_;
  double start_;
  std::vector<Stream> streams_;
};

}  // namespace palpate::app
