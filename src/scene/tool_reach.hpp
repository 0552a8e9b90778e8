#pragma once

#include <Eigen/Core>

#include "palpate/scene/reach.hpp"

namespace palpate {

/// Foresees where a tool can be until the next frames have become a surface. Real-time.
class ToolReach {
 public:
  /// `scale`: metres that the tool goes for one of the hand.
  explicit ToolReach(double scale = 1) : scale_(scale) {}

  /// `now`: s; hip and proxy are finite, m. `frame`: time between frames, s. `margin`: how far
  /// around itself the tool feels, m.
  [[nodiscard]] Reach update(double now, const Eigen::Vector3d& hip, const Eigen::Vector3d& proxy,
                             double frame, double margin) noexcept;

 private:
  double scale_;
  double last_time_ = 0;
  Eigen::Vector3d last_hip_ = Eigen::Vector3d::Zero();
  double speed_ = 0;  // of late, m/s
  bool started_ = false;
};

}  // namespace palpate
