// A robot on a machine that gets to its camera's frames late.
#include <gmock/gmock.h>

#include <cmath>
#include <deque>

#include "ros/robot_rig.hpp"

namespace palpate::ros {
namespace {

using ::testing::HasSubstr;

constexpr double kQuick = 0.02;  // s from a frame to its source
constexpr double kStarved = 0.24;

class ALateRobot : public ARobot {
 protected:
  /// Looks for some time, while frames arrive `delay` after they are taken and the tool goes to and
  /// fro at `speed`. `height`: of the true wall. Returns how many targets were told.
  int looks(double seconds, double delay, double speed, const Height& height) {
    int told = 0;
    for (const double end = now_ + seconds; now_ < end; now_ += kLook) {
      if (now_ >= taken_) taken_ += kFrame, frames_.push_back(now_);
      while (!frames_.empty() && frames_.front() + delay <= now_) {
        const double stamp = frames_.front();
        frames_.pop_front();
        (void)cameras_.front().source->push(
            frame_of(small_camera(), stamp, wall(0.5 - height(stamp))),
            [this] { return now_ + 0.01; });
      }
      state_.velocity = Vector3d(speed, 0, 0);
      answer_ = guide_->look(state_, now_, false);
      if (!answer_.target) continue;
      ++told;
      const double place = answer_.target->position.z();
      deepest_ = std::max(deepest_, height(now_) - place);
    }
    return told;
  }

  RobotGuide::Answer answer_;
  double deepest_ = 0;  // of what was told, in the true wall, m

 private:
  std::deque<double> frames_;  // taken, and on their way
  double taken_ = 0;
};

TEST_F(ALateRobot, FollowsNoToolThatIsFasterThanWhatIsSeenLate) {
  camera("camera", at_rest);
  starts();
  tool_at({0, 0, 0.05});
  EXPECT_GT(looks(2, kQuick, 0.3, at_rest), 400);
  EXPECT_LT(answer_.age, kQuick + kFrame + kLook);
  (void)looks(0.5, kStarved, 0.3, at_rest);
  EXPECT_EQ(looks(2, kStarved, 0.3, at_rest), 0);
  EXPECT_THAT(answer_.why, HasSubstr("shows nothing new (camera, 0.2"));
  EXPECT_GT(looks(2, kStarved, 0.03, at_rest), 350) << "10 mm in the time that frames are late";
  EXPECT_GT(answer_.age, kStarved);
  EXPECT_GT(looks(2, kQuick, 0.3, at_rest), 400);
}

// Held by a wall that goes up and down by up to 0.54 m/s.
TEST_F(ALateRobot, FollowsNoSurfaceThatIsFasterThanWhatIsSeenLate) {
  const auto swings = [](double t) { return 0.03 * std::sin(18 * t); };
  camera("camera", swings);
  starts();
  const auto rides = [&](double seconds, double delay) {
    int told = 0;
    for (int k = 0; k < static_cast<int>(seconds / kLook); ++k) {
      presses_at(swings(now_ - delay));
      state_.contact.drift = Vector3d(0, 0, 0.54 * std::cos(18 * (now_ - delay)));
      told += looks(0.5 * kLook, delay, 0, swings);
    }
    return told;
  };
  (void)rides(2, kQuick);
  (void)rides(0.5, kStarved);
  deepest_ = 0;
  (void)rides(3, kStarved);
  EXPECT_LT(deepest_, 0.02);
}

}  // namespace
}  // namespace palpate::ros
