#pragma once

#include <cstddef>
#include <utility>

#include "palpate/io/trajectory.hpp"

namespace palpate {

/// The place on a trajectory at times that grow: straight between rows, at rest before the first
/// and after the last. Real-time but for construction.
class Playback {
 public:
  /// `trajectory` as check() of scripted.hpp wants it, or empty.
  explicit Playback(Trajectory trajectory = {}) : rows_(std::move(trajectory)) {}

  [[nodiscard]] bool empty() const noexcept { return rows_.empty(); }
  /// s; of a trajectory that is not empty.
  [[nodiscard]] double end() const noexcept { return rows_.back().time; }
  [[nodiscard]] const TrajectoryRow& front() const noexcept { return rows_.front(); }

  /// m; `time` is not before that of the last call, unless rewind() came between. Not empty.
  [[nodiscard]] Eigen::Vector3d at(double time) noexcept;
  void rewind() noexcept { cursor_ = 0; }

 private:
  Trajectory rows_;
  std::size_t cursor_ = 0;  // row before the time asked for last
};

}  // namespace palpate
