#pragma once

#include <condition_variable>
#include <mutex>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {

/// Where a reading and a preparing thread meet: one frame waits at most. Frames change hands by
/// swapping, so that their memory goes round.
class FrameExchange {
 public:
  /// `lossless`: the reader waits until its last frame is taken instead of overtaking it.
  explicit FrameExchange(bool lossless) : lossless_(lossless) {}

  enum class Offer { taken, overtook, stopped };

  /// Reader: waits until a frame may be read. False: stop.
  [[nodiscard]] bool wait_for_room();
  /// Reader: leaves a frame and gets an old one.
  [[nodiscard]] Offer offer(DepthFrame& frame);
  /// Reader: waits for some time, s of the host. False: stop.
  [[nodiscard]] bool pause(double seconds);
  /// Reader: no frame will follow.
  void end();

  /// Preparer: waits for a frame. False: stop, or the end.
  [[nodiscard]] bool take(DepthFrame& frame);
  [[nodiscard]] bool ended();

  /// Anyone: both are to stop.
  void stop();

 private:
  const bool lossless_;
  std::mutex mutex_;
  std::condition_variable changed_;
  DepthFrame frame_;
  bool full_ = false;
  bool ended_ = false;
  bool stopped_ = false;
};

}  // namespace palpate::sensor
