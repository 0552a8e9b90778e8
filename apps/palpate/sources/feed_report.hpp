#pragma once

#include <vector>

#include "palpate/sensor/stream.hpp"

namespace palpate::app {

/// What a camera's run looked like.
struct FeedReport {
  StreamState state;
  int width = 0;  ///< of the last frame, pixels
  int height = 0;
  bool simulated = false;          ///< in simulated time, where no frame is overtaken
  std::vector<double> prepare_ms;  ///< computing time of each frame's preparation, ms
};

}  // namespace palpate::app
