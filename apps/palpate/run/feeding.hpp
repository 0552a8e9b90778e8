#pragma once

#include <vector>

#include "apps/palpate/sources/touched.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::app {

/// Makes the frames of `touched` part of `felt` and notes in `touched.feed` what they were like,
/// with their preparation's time as `computing` tells it (s). Both outlive the sink; until its
/// stream has ended the notes are the stream's.
[[nodiscard]] FrameSink feeding(TouchedSource& touched, Source& felt, double (*computing)());

/// Keeps how the streams and the sources that they fed fared, of everything in `touched` that
/// lives. `states` are in the order of the sources.
void keep_states(Touched& touched, const Scene& felt, const std::vector<StreamState>& states);

}  // namespace palpate::app
