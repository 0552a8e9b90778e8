#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>

namespace palpate {

/// Takes a hand's target along a way, straight from corner to corner. One thread uses it;
/// real-time.
class Flight {
 public:
  /// Begins with the corner that is nearest to `position`, m, among the first `among`. The corners
  /// are not copied.
  void begin(std::span<const Eigen::Vector3d> corners, const Eigen::Vector3d& position,
             std::size_t among) noexcept {
    corners_ = corners;
    start_ = position;
    next_ = 0;
    for (std::size_t i = 1; i < among && i < corners.size(); ++i) {
      const auto distance = [&](std::size_t k) { return (corners[k] - position).squaredNorm(); };
      if (distance(i) < distance(next_)) next_ = i;
    }
  }

  /// The corners ahead are those of `corners` now, which is as the way before but for its end. Also
  /// a flight that was over goes on to that.
  void lead(std::span<const Eigen::Vector3d> corners) noexcept {
    corners_ = corners;
    if (over() && !corners.empty()) next_ = corners.size() - 1;
  }

  [[nodiscard]] bool over() const noexcept { return next_ >= corners_.size(); }

  /// Moves `target` on for `dt`, s, at up to `speed`, m/s, and slower near both ends.
  void go(Eigen::Vector3d& target, double speed, double dt) noexcept {
    double reach = std::min(speed, careful(target)) * dt;
    for (; !over(); ++next_) {
      const Eigen::Vector3d path = corners_[next_] - target;
      const double length = path.norm();
      if (length > reach) {
        target += reach / length * path;
        return;
      }
      target = corners_[next_];
      reach -= length;
    }
  }

 private:
  // m/s at both ends, where a hand may touch: 0.1 kg on 500 N/m make 0.35 N of it.
  static constexpr double kTouching = 0.05;
  static constexpr double kCareful = 0.1;  // s: a metre from them it is so much faster (judgement)

  [[nodiscard]] double careful(const Eigen::Vector3d& target) const noexcept {
    double away = (target - start_).norm();
    if (next_ + 1 == corners_.size()) away = std::min(away, (corners_[next_] - target).norm());
    return kTouching + away / kCareful;
  }

  std::span<const Eigen::Vector3d> corners_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  std::size_t next_ = 0;
};

}  // namespace palpate
