#pragma once

#include <vector>

#include "apps/palpate/sources/touched.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::app {

/// Makes the frames of `touched` part of `felt` and notes in `touched.feed` what they were like,
/// with their preparation's time as `computing` tells it (s). Both outlive the sink; until its
/// stream has ended the notes are the stream's.
[[nodiscard]] FrameSink feeding(TouchedSource& touched, Source& felt, double (*computing)());

/// Keeps how the streams and the sources that they fed fared, of everything in `touched` that
/// lives. `states` are in the order of the sources.
void keep_states(Touched& touched, const Scene& felt, const std::vector<StreamState>& states);

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
