// Declares how points move and fade while a snapshot lasts.
#pragma once

#include <cstdint>

#include "depth/frame_timing.hpp"
#include "palpate/field/field_options.hpp"
#include "stream/fate.hpp"
#include "stream/frame_blocks.hpp"
#include "stream/moving_points.hpp"
#include "stream/shown_points.hpp"

namespace palpate {

struct MorphOptions {
  double silence = 0.3;  ///< a point that nothing confirmed for so long begins to fade, s
  double fade = 0.5;     ///< in which it fades away, s
  Kernel kernel = Kernel::wyvill;
  double minimum_radius = 0;  ///< no R below this, m
};

/// Returns for each fate where a point goes while the next snapshot lasts, and its presence then.
class PointMoves {
 public:
  /// All have to last as long.
  PointMoves(const MorphOptions& options, const ShownPoints& shown, const FrameBlocks& blocks)
      : options_(options), shown_(shown), blocks_(blocks) {}

  /// `last`: no frame follows. `still`: what appears is there at once.
  void begin(const FrameTiming& moment, bool last, bool still);

  /// Has a frame shown the old point within `silence`?
  [[nodiscard]] bool is_fresh(std::uint32_t i) const;

  /// A point that was not there before.
  [[nodiscard]] PointMotion appear(const SeenPoint& seen) const;

  /// Moves the old point, which was at `from`, to the new one.
  [[nodiscard]] PointMotion update(const SeenPoint& seen, std::uint32_t i,
                                   const PointState& from) const;

  /// Does the same for points within R, in four lanes, from `motions.from` and their old variances.
  void update(const SeenFour& seen, PointMotion4& motions) const;

  /// Confirms the old point where it was.
  [[nodiscard]] PointMotion confirm(std::uint32_t i, const PointState& from) const;

  /// `fate`: of a point that is not seen again.
  [[nodiscard]] PointMotion unseen(Fate fate, std::uint32_t i) const;

  /// Removes a point: takes its weight from it.
  static void remove(PointMotion& motion);

  /// Has a removed point no weight left that can be felt?
  [[nodiscard]] static bool is_gone(const PointMotion& motion);

  /// What is remembered of a point that a frame shows.
  [[nodiscard]] Entry seen_entry(float variance) const { return Entry{moment_.stamp, variance}; }

 private:
  [[nodiscard]] float share_of(double time) const;
  [[nodiscard]] EdgeMotion edge_of(const SeenPoint& seen, std::uint32_t i) const;
  [[nodiscard]] PointMotion retain(std::uint32_t i) const;
  [[nodiscard]] PointMotion hide(std::uint32_t i) const;
  [[nodiscard]] PointMotion fade(std::uint32_t i) const;
  [[nodiscard]] PointMotion remove(std::uint32_t i) const;
  [[nodiscard]] PointMotion retained(std::uint32_t i, const PointState& from, float presence,
                                     EntryKind kind, double confirmed) const;

  const MorphOptions& options_;
  const ShownPoints& shown_;
  const FrameBlocks& blocks_;
  FrameTiming moment_;
  float comes_ = 1;  // presence that what is seen gains
  float doubt_ = 1;  // by which prior variances grow
  bool ends_ = false;
  bool still_ = false;
};

}  // namespace palpate
