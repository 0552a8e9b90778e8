#pragma once

#include <vector>

#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::app {

/// Makes the frames of `from` part of `to` and notes in `from.feed` what they were like, with their
/// preparation's time as `computing` tells it (s). Both outlive the sink; until its stream has
/// ended the notes are the stream's.
[[nodiscard]] FrameSink feeding(LoadedSource& from, Source& to, double (*computing)());

/// Keeps how the streams and the sources that they fed fared. `states` are in the order of the
/// sources.
void keep_states(LoadedScene& loaded, const std::vector<StreamState>& states);

/// The streams of everything in `loaded` that lives, into its scene; it outlives them.
class LiveFeed {
 public:
  /// Recordings begin together at `start`, s on the clock.
  LiveFeed(LoadedScene& loaded, const Clock& clock, double start);

  /// How each stream fares, in the order of the sources.
  [[nodiscard]] std::vector<StreamState> states() const;

  /// Ends the streams and puts what they were like into `loaded`, times counted from the start.
  void finish();

 private:
  LoadedScene& loaded_;
  double start_;
  std::vector<Stream> streams_;
};

}  // namespace palpate::app
