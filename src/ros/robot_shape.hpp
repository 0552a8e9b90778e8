#pragma once

#include <cstddef>
#include <vector>

#include "palpate/geometry/pose.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::ros {

/// What has to be free around a robot's handle: the ball of a point, or all of a tool.
class RobotShape {
 public:
  /// `radius`: m; 0: a point.
  explicit RobotShape(double radius);
  /// Balls around the handle, one or more, in its axes, m.
  explicit RobotShape(std::vector<Ball> balls);

  /// Where it is, world.
  [[nodiscard]] std::vector<Ball> at(const Pose& pose) const;
  /// m; how far the part that goes farthest goes at most, if it moves straight and turns evenly.
  [[nodiscard]] double way(const Pose& from, const Pose& to) const;
  /// Where it is after a share (0 to 1) of that.
  [[nodiscard]] static Pose between(const Pose& from, const Pose& to, double share);
  /// How many balls it is.
  [[nodiscard]] std::size_t size() const { return balls_.size(); }
  /// Radius of its thinnest part, m; 0: it is a surface.
  [[nodiscard]] double thinnest() const { return thinnest_; }
  /// Do its parts see a camera along rays of their own?
  [[nodiscard]] bool is_wide() const { return lever_ > 0; }

 private:
  std::vector<Ball> balls_;
  double lever_ = 0;  // m, of the farthest
  double thinnest_ = 0;
};

}  // namespace palpate::ros
