#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace palpate {

/// How a source fares, for those who show or log it.
struct SourceState {
  std::uint64_t frames = 0;   ///< frames and clouds that became a surface
  std::uint64_t dropped = 0;  ///< that did not, because fields that stand still held all snapshots
  std::string slowest = {};   ///< name of such a field, when the last drop was; empty: never
  double interval = 0;        ///< time between frames, smoothed, s; 0: none yet
  double latency = 0;         ///< of the last one, from its stamp to the start of its surface, s
  double stamp = 0;           ///< of the last one, s
  std::size_t points = 0;     ///< of the newest surface's newest layer
  double noise = 0;           ///< sigma of one pixel at `depth`, m; 0: no depth frame yet
  double depth = 0;           ///< median depth of the last frame, m
  double correlation = 0;     ///< c of NoiseModel
  double silent_from = 0;     ///< when the surface begins to fade unless a frame comes, s
  double fade = 0;            ///< in which it fades away then, s
  /// Median distance along the normals between this source's surface and the others', where both
  /// see it, m; the worst of the others. Scene::state() only.
  std::optional<double> disagreement = {};

  [[nodiscard]] double rate() const { return interval > 0 ? 1 / interval : 0; }  ///< Hz
};

}  // namespace palpate
