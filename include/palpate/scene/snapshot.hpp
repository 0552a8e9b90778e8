#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "palpate/field/surface_points.hpp"

namespace palpate {

/// Shared points and how much they count: a weight at the snapshot's start and one at its end.
struct Layer {
  std::shared_ptr<const SurfacePoints> points;
  double weight_start = 1;
  double weight_end = 1;
};

/// What crosses from preparation to the servo: one source's surface over a stretch of time.
/// Immutable, in the world frame. Between start and end everything goes in straight lines; before
/// and after it stands still. The weights of a source's layers sum to 1 at every time.
struct Snapshot {
  static constexpr std::size_t kMaxLayers = 8;

  double start = 0;           ///< s, on the clock that SceneField::update is given
  double end = 0;             ///< s; not before start
  double presence_start = 1;  ///< 0-1: is the sensor still sure of what it saw?
  double presence_end = 1;
  /// From this time on presence fades to 0 in `fade` s, unless a newer snapshot comes: nobody has
  /// to publish for a silent sensor's surface to fade away. Infinite: never.
  double silent_from = std::numeric_limits<double>::infinity();
  double fade = 0.5;           ///< s
  double interval = 0;         ///< time between its source's frames, s; 0: nothing follows
  double stamp = 0;            ///< when the newest data in it was taken, s, same clock
  std::uint64_t sequence = 0;  ///< counts a source's snapshots
  std::vector<Layer> layers;
};

/// How far `snapshot` has gone at `time` (s): 0 at its start and before, 1 at its end and after.
[[nodiscard]] double progress(const Snapshot& snapshot, double time) noexcept;

/// How sure its sensor is of it at `time` (s), 0-1.
[[nodiscard]] double presence(const Snapshot& snapshot, double time) noexcept;

}  // namespace palpate
