// The balls that stand for what a robot holds, and how far they go where it moves and turns.
#include "ros/robot_shape.hpp"

#include <algorithm>
#include <utility>

#include "geometry/turn.hpp"

namespace palpate::ros {

RobotShape::RobotShape(double radius)
    : balls_{{Eigen::Vector3d::Zero(), radius}}, thinnest_(radius) {}

RobotShape::RobotShape(std::vector<Ball> balls)
    : balls_(std::move(balls)), thinnest_(std::ranges::min(balls_, {}, &Ball::radius).radius) {
  for (const Ball& ball : balls_) lever_ = std::max(lever_, ball.center.norm());
}

std::vector<Ball> RobotShape::at(const Pose& pose) const {
  std::vector<Ball> placed;
  placed.reserve(balls_.size());
  const Eigen::Matrix3d turned = pose.orientation.normalized().toRotationMatrix();
  for (const Ball& ball : balls_) {
    placed.push_back({pose.position + turned * ball.center, ball.radius});
  }
  return placed;
}

double RobotShape::way(const Pose& from, const Pose& to) const {
  return (to.position - from.position).norm() +
         lever_ * turn_between(from.orientation, to.orientation).norm();
}

Pose RobotShape::between(const Pose& from, const Pose& to, double share) {
  return {from.position + share * (to.position - from.position),
          from.orientation.slerp(share, to.orientation)};
}

}  // namespace palpate::ros
