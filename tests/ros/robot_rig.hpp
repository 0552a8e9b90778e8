#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ros/robot_guide.hpp"
#include "support/depth_frames.hpp"

namespace palpate::ros {

using namespace test;
using Eigen::Vector3d;

inline constexpr double kFrame = 1.0 / 30;  // s
inline constexpr double kLook = 1.0 / 250;  // s
inline constexpr double kRetreat = 0.05;    // m/s
inline constexpr double kNoise = 4e-3;      // m; three deviations of a window there, and more

/// A robot that follows a proxy, and hand, over walls that cameras see from z = 0.5 m. The walls
/// are at heights that change with time.
class ARobot : public ::testing::Test {
 protected:
  using Height = std::function<double(double t)>;

  Source& camera(const std::string& name, Height height) {
    cameras_.push_back({&scene_.add(name, {.T_world_sensor = looking_down()}), std::move(height)});
    return *cameras_.back().source;
  }
  void starts(std::vector<std::string> sources = {}) {
    guide_.emplace(scene_,
                   RosBridgeOptions::Robot{
                       .preset = "crisp", .sources = std::move(sources), .retreat = kRetreat},
                   shape_);
  }
  // The last answer of some time in which the tool stays where it is.
  RobotGuide::Answer runs(double seconds, bool anew = false) {
    RobotGuide::Answer answer;
    for (const double end = now_ + seconds; now_ < end; now_ += kLook) {
      if (now_ >= frames_ * kFrame) push();
      answer = guide_->look(state_, now_, std::exchange(anew, false));
      if (each_) each_(answer);
    }
    return answer;
  }
  void tool_at(const Vector3d& place) {
    state_.hip = place;
    state_.tool.position = place;
    state_.contact.touching = false;
  }
  // Held at a height of `proxy`, the hand so much below.
  void presses_at(double proxy, double depth = 0.02) {
    tool_at({0, 0, proxy});
    state_.hip.z() -= depth;
    state_.contact.touching = true;
  }

  struct Camera {
    Source* source;
    Height height;
    bool on = true;
    int every = 1;  ///< frames of the quickest camera
  };
  RobotShape shape_{0};
  Scene scene_;
  std::vector<Camera> cameras_;
  std::optional<RobotGuide> guide_;
  ServoState state_;
  std::function<void(const RobotGuide::Answer&)> each_;
  double now_ = 0;
  double pushed_ = 0;  // stamp of the newest frame, s

 private:
  void push() {
    pushed_ = now_;
    for (const Camera& camera : cameras_) {
      if (!camera.on || frames_ % camera.every != 0) continue;
      const double height = camera.height(now_);
      const DepthOf depth = height > 0.5 ? [](double, double) { return 0.0; } : wall(0.5 - height);
      (void)camera.source->push(frame_of(small_camera(), now_, depth),
                                [this] { return now_ + 0.01; });
    }
    ++frames_;
  }
  int frames_ = 0;
};

inline std::optional<Vector3d> place_of(const RobotGuide::Answer& answer) {
  return answer.target ? std::optional(answer.target->position) : std::nullopt;
}

inline double at_rest(double /*t*/) {
  return 0;
}

}  // namespace palpate::ros
