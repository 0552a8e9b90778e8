#pragma once

#include <functional>
#include <string>
#include <vector>

#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate::app {

/// What a camera's run looked like.
struct FeedReport {
  StreamState state;
  int width = 0;  ///< of the last frame, pixels
  int height = 0;
  double first_stamp = 0;          ///< s, from t = 0
  double last_stamp = 0;           ///< s
  std::vector<double> prepare_ms;  ///< computing time of each frame's preparation, ms
};

/// Cameras and preparation on a simulated clock: each frame is prepared when simulated time comes
/// to its stamp plus the latency, and felt from then on. t = 0 is the first frame's stamp of all
/// cameras. One thread; the same cameras give the same surfaces, bit for bit.
class SimulatedFeed {
 public:
  /// A camera that does not pace itself (CameraInfo::paces), its first frame, what it feeds.
  struct Feeding {
    DepthCamera* camera = nullptr;
    DepthFrame first;
    std::string source;  ///< name, for messages
    FrameSink sink;
    std::function<void()> ended = [] {};  ///< called after the last frame of a recording
  };

  /// Cameras outlive the feed. `latency`: from stamp to touchable, s.
  SimulatedFeed(std::vector<Feeding> cameras, double latency);

  /// Makes touchable what is due at `now` (s): the earliest frame first, of frames of one time that
  /// of the camera that was given first. What cameras and preparation complain of is counted.
  void advance(double now);

  /// In the order of the cameras.
  [[nodiscard]] std::vector<FeedReport> reports() const;

 private:
  struct Lane {
    DepthCamera* camera = nullptr;
    DepthFrame next;
    FrameSink sink;
    std::function<void()> ended;
    bool pending = true;  // is there a frame that waits for its time?
    FeedReport report;
  };

  void push(Lane& lane);
  void read_next(Lane& lane);
  [[nodiscard]] Lane* earliest();

  std::vector<Lane> lanes_;
  double latency_ = 0;
  double start_ = 0;  // stamp of t = 0
};

}  // namespace palpate::app
