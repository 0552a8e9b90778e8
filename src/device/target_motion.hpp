#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <utility>

#include "palpate/geometry/pose.hpp"
#include "palpate/io/trajectory.hpp"

// Moves a hand's target between given positions: along a trajectory, or after commands that come
// one by one. One thread uses each; real-time but for construction.
namespace palpate {

/// The pose on a trajectory at times that grow: linear between rows, at rest before the first and
/// after the last.
class Playback {
 public:
  /// `trajectory`: empty, or such that check() accepts it.
  explicit Playback(Trajectory trajectory = {}) : rows_(std::move(trajectory)) {}

  [[nodiscard]] bool empty() const noexcept { return rows_.empty(); }
  /// s; of a trajectory that is not empty.
  [[nodiscard]] double end() const noexcept { return rows_.back().time; }
  [[nodiscard]] const TrajectoryRow& front() const noexcept { return rows_.front(); }

  /// `time` is not before that of the last call, unless rewind() came between. Not empty.
  [[nodiscard]] Pose at(double time) noexcept {
    while (cursor_ + 1 < rows_.size() && rows_[cursor_ + 1].time <= time) ++cursor_;
    const Pose a = pose_of(rows_[cursor_]);
    const double since = time - rows_[cursor_].time;
    if (cursor_ + 1 == rows_.size() || since <= 0) return a;
    const Pose b = pose_of(rows_[cursor_ + 1]);
    const double share = since / (rows_[cursor_ + 1].time - rows_[cursor_].time);
    return {a.position + share * (b.position - a.position),
            a.orientation.slerp(share, b.orientation), a.opening + share * (b.opening - a.opening)};
  }
  void rewind() noexcept { cursor_ = 0; }

 private:
  static Pose pose_of(const TrajectoryRow& row) noexcept {
    return {row.position, row.orientation.value_or(Eigen::Quaterniond::Identity()),
            row.opening.value_or(0)};
  }

  Trajectory rows_;
  std::size_t cursor_ = 0;  // row before the time of the last call
};

/// Interpolates positions that come one by one, at irregular times, 20 to 1000 a second: from where
/// it is, straight to the newest one, within 1.25 times the usual interval between two. So it lags
/// a little, rests where nothing comes, and never overshoots; even motion stays even while
/// positions come up to a quarter of the interval late.
class TargetInterpolator {
 public:
  static constexpr double kReserve = 1.25;   ///< intervals that a move takes
  static constexpr double kShortest = 1e-3;  ///< s, of an interval
  static constexpr double kLongest = 0.05;   ///< s; longer gaps are pauses, and not averaged

  /// Rests at `position`, m, from `time` on, s.
  void rest(const Eigen::Vector3d& position, double time) noexcept {
    from_ = position;
    to_ = position;
    start_ = time;
    duration_ = 0;
    moving_ = false;
  }

  /// A position, m, that was received at `time`, s; `stamp`: the sender's time, s, of which only
  /// differences count.
  void go(const Eigen::Vector3d& position, double stamp, double time) noexcept {
    const double since = stamp - stamp_;
    if (moving_ && since > 0 && since <= kLongest) {
      interval_ += kShare * (std::max(since, kShortest) - interval_);
    }
    from_ = at(time);
    to_ = position;
    start_ = time;
    duration_ = kReserve * interval_;
    stamp_ = stamp;
    moving_ = true;
  }

  /// m; `time` in s, not before that of the last rest() or go().
  [[nodiscard]] Eigen::Vector3d at(double time) const noexcept {
    const double gone = time - start_;
    if (gone >= duration_) return to_;
    return from_ + std::max(gone, 0.0) / duration_ * (to_ - from_);
  }

  /// Mean time between two positions, s.
  [[nodiscard]] double interval() const noexcept { return interval_; }

 private:
  static constexpr double kShare = 1.0 / 8;  // of a new interval in the mean

  Eigen::Vector3d from_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_ = Eigen::Vector3d::Zero();
  double start_ = 0;
  double duration_ = 0;
  double interval_ = 1.0 / 60;
  double stamp_ = 0;
  bool moving_ = false;  // stamp_ is that of the position before
};

}  // namespace palpate
