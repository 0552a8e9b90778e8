#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "depth/frame_timing.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/scene/source.hpp"

namespace palpate {

/// A frame, where it was taken, and how its pixels err.
struct PosedFrame {
  DepthFrame frame;
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  NoiseModel noise;
};

/// Ages up to which a frame counts at most, s; infinite: it stays.
struct FrameLimits {
  double at_first = 0;  ///< while it is unknown when frames are due
  double later = 0;     ///< however late they are due then
};

/// Decides whether positions are free, from a depth camera's newest raw frames alone. The surface
/// is not involved. One thread adds frames, any thread reads.
class Sight {
 public:
  /// Keeps a copy of the frame, which has passed depth::check(). `noise`: of its pixels. Once
  /// frames of one size have come, it takes no memory. Passes over a frame that is older than
  /// the one before, and starts again with the next where that is older, too.
  void see(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor,
           const NoiseModel& noise);

  /// Forgets all frames.
  void forget();

  /// Returns what was seen of all of these balls, one or more, at `now` (s, on the clock of the
  /// stamps). A frame counts until the next one is due, and no longer than `limits`. Frequent calls
  /// let it measure when frames are due: by how old they are at the first call. Nothing: no frame
  /// has come.
  [[nodiscard]] std::optional<Seen> at(std::span<const Ball> balls, double now,
                                       const FrameLimits& limits);
  [[nodiscard]] std::optional<Seen> at(const Ball& ball, double now, const FrameLimits& limits) {
    return at(std::span(&ball, 1), now, limits);
  }

 private:
  void note_question(double now);
  [[nodiscard]] double lasts(const FrameLimits& limits) const;
  [[nodiscard]] bool before_counts(double now, double lasts) const;

  std::mutex mutex_;  // of what follows
  PosedFrame newest_;
  PosedFrame before_;         // the one before
  PosedFrame base_;           // an earlier one, that gives speeds where frames come quickly
  int frames_ = 0;            // of the first three that have come
  bool read_ = false;         // has the newest one been read?
  bool read_before_ = false;  // and the one before?
  FrameLifetime lifetime_;

  PosedFrame spare_;   // the thread's that shows frames
  bool late_ = false;  // the same thread's: was the last frame older than the newest?
};

}  // namespace palpate
