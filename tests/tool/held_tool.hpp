#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "palpate/tool/tool_field.hpp"
#include "support/point_shapes.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {

inline PointCloud cloud_of(const std::vector<TestPoint>& points, bool normals = false) {
  PointCloud cloud;
  for (const TestPoint& p : points) {
    cloud.positions.push_back(p.position.cast<float>());
    if (normals) cloud.normals.push_back(p.normal.cast<float>());
  }
  return cloud;
}

/// A scene, and a tool that a hand holds in it, one millisecond after the other.
class HeldTool {
 public:
  HeldTool(Scene& scene, Tool tool, const ToolOptions& options = kOptions)
      : tool_(std::make_shared<const Tool>(std::move(tool))),
        field_(scene, tool_),
        proxy_(tool_, options) {}

  ToolContact step(const Pose& hand) {
    field_.update(1e-3 * ticks_++, hand, proxy_);
    return proxy_.step(field_, hand, kTick);
  }

  /// Moves from where the hand was last to `goal`, and rests there.
  ToolContact to(const Pose& goal, int steps = 100, int rest = 100) {
    const Pose from = hand_;
    const Eigen::Vector3d turn = turn_between(from.orientation, goal.orientation);
    ToolContact contact;
    for (int i = 1; i <= steps + rest; ++i) {
      const double share = std::min(1.0, static_cast<double>(i) / steps);
      hand_.position = from.position + share * (goal.position - from.position);
      hand_.orientation = turned(from.orientation, share * turn);
      hand_.opening = from.opening + share * (goal.opening - from.opening);
      contact = step(hand_);
    }
    return contact;
  }
  void reset(const Pose& pose) {
    hand_ = pose;
    proxy_.reset(pose);
  }

  /// The deepest that a sample is in the surface, in R; below 0: none is.
  [[nodiscard]] double depth() const {
    double deepest = -1;
    for (std::size_t i = 0; i < tool_->samples().size(); ++i) {
      const Tool::Point& each = tool_->samples()[i];
      const Eigen::Vector3d x = tool_->in_world(each.position, each.side, proxy_.pose());
      const Sample here = field_.group(field_.group_of(static_cast<int>(i))).sample(x);
      const double slope = here.gradient.norm();
      if (!(slope > 0) || here.averted) continue;
      deepest = std::max(deepest, (each.radius - here.value / slope) / here.radius);
    }
    return deepest;
  }

  [[nodiscard]] ToolField& field() { return field_; }
  [[nodiscard]] double now() const { return 1e-3 * ticks_; }  ///< s
  [[nodiscard]] const Pose& pose() const { return proxy_.pose(); }

 private:
  std::shared_ptr<const Tool> tool_;
  ToolField field_;
  ToolProxy proxy_;
  Pose hand_;
  int ticks_ = 0;
};

}  // namespace palpate::test
