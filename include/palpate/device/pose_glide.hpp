#pragma once

#include <Eigen/Core>

namespace palpate {

/// A way through places that come one by one, at irregular times, 20 to 1000 a second: from where
/// it is, straight to the newest place, in the time that mostly lies between two places, and a
/// quarter more. So it is a little late, rests where nothing comes, and never goes beyond what it
/// was told; even motion stays even while places come up to a quarter too late.
///
/// One thread uses it; real-time.
class PoseGlide {
 public:
  static constexpr double kReserve = 1.25;   ///< intervals that a way to a place takes
  static constexpr double kShortest = 1e-3;  ///< s, of an interval
  static constexpr double kLongest = 0.05;   ///< s; those between places further apart are pauses

  /// Rests at `position`, m, from `time` on, s.
  void rest(const Eigen::Vector3d& position, double time) noexcept;

  /// A place, m, that became known at `time`, s; `stamp` is the sender's time, s, and tells the
  /// interval alone.
  void go(const Eigen::Vector3d& position, double stamp, double time) noexcept;

  /// m; `time` in s, not before that of the last rest() or go().
  [[nodiscard]] Eigen::Vector3d at(double time) const noexcept;

  /// s, that mostly lies between two places.
  [[nodiscard]] double interval() const noexcept { return interval_; }

 private:
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_ = Eigen::Vector3d::Zero();
  double start_ = 0;
  double duration_ = 0;
  double interval_ = 1.0 / 60;
  double stamp_ = 0;
  bool moving_ = false;  // stamp_ is that of the place before
};

}  // namespace palpate
