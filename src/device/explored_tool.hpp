#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "device/explore.hpp"

namespace palpate {

/// What a hand that explores holds, turned as the world's axes are: balls around its handle; none:
/// a point.
class ExploredTool {
 public:
  explicit ExploredTool(std::vector<Ball> balls) : balls_(std::move(balls)) {}

  /// How far it reaches from its handle against a surface's normal (unit), m.
  [[nodiscard]] double reach(const Eigen::Vector3d& normal) const {
    double reach = 0;
    for (const Ball& each : balls_) reach = std::max(reach, each.radius - normal.dot(each.center));
    return reach;
  }

  /// Is all of it, or some hundred of its balls, so far from all points with its handle there? A
  /// tool that begins within a surface is held by it.
  [[nodiscard]] bool fits(const SurfaceMap& map, const Eigen::Vector3d& handle, double room) const {
    const std::size_t stride = balls_.size() / kTried + 1;
    for (std::size_t i = 0; i < balls_.size(); i += stride) {
      if (map.distance(handle + balls_[i].center) < balls_[i].radius + room) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kTried = 100;  // balls; judgement

  std::vector<Ball> balls_;
};

}  // namespace palpate
