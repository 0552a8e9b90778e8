#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "palpate/tool/tool.hpp"
#include "ros/robot_rig.hpp"

namespace palpate::ros {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using ::testing::HasSubstr;

inline constexpr double kSpacing = 2.5e-3;  // m

inline RobotShape box_shape(double length = 0.08) {
  const Tool box = Tool::box({length, 0.02, 0.01}, kSpacing);
  std::vector<Ball> balls;
  for (const Tool::Point& sample : box.samples()) {
    balls.push_back({sample.position, 0});
  }
  return RobotShape(balls);
}

inline Quaterniond tilted(double angle) {
  return Quaterniond(AngleAxisd(angle, Vector3d::UnitY()));
}

inline Quaterniond turned(double angle) {
  return Quaterniond(AngleAxisd(angle, Vector3d::UnitZ()));
}

// A box of 80 x 20 x 10 mm around its handle, over a wall that a camera sees from above.
class ARobotWithATool : public ARobot {
 protected:
  void SetUp() override {
    shape_ = box_shape();
    camera("camera", at_rest);
    starts();
  }
  void box_at(const Vector3d& place, const Quaterniond& orientation = Quaterniond::Identity()) {
    tool_at(place);
    state_.orientation = state_.tool.orientation = orientation;
  }
  // From the handle to the lowest corner of a box that is tilted.
  static double below(double angle) { return 0.04 * std::sin(angle) + 0.005 * std::cos(angle); }
  // The camera sees this from now on.
  void sees(const DepthOf& depth) { sees_ = depth; }
  RobotGuide::Answer looks(double seconds, bool anew = false) {
    if (!sees_) return runs(seconds, anew);
    RobotGuide::Answer answer;
    for (const double end = now_ + seconds; now_ < end; now_ += kFrame) {
      (void)cameras_.front().source->push(frame_of(small_camera(), now_, sees_),
                                          [this] { return now_ + 0.01; });
      answer = guide_->look(state_, now_, std::exchange(anew, false));
    }
    return answer;
  }

 private:
  DepthOf sees_;
};

}  // namespace palpate::ros
