// Checks tools on streams of depth frames: surfaces that rest, rise, are hidden, vanish and return.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "palpate/tool/tool_field.hpp"
#include "support/depth_frames.hpp"
#include "support/stream_run.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kInterval = 1.0 / 30;
constexpr double kLead = 2e-3;  // s, from a frame until its surface begins

/// What a camera that looks straight down sees of a height (m) over x and y.
using HeightAt = std::function<double(double x, double y)>;

DepthOf seen_from_above(const HeightAt& height) {
  return [height](double x, double y) {
    double depth = 0.5;  // a few rounds suffice for what is nearly flat
    for (int i = 0; i < 8; ++i) depth = 0.5 - height(depth * x, -depth * y);
    return depth;
  };
}

/// A box on what a camera sees, which looks down from 0.5 m.
class ToolOnAStream : public testing::Test {
 protected:
  // Goes on to `end` (s) with a new frame every 33 ms, a hand, and what is to be seen of each step.
  void until(double end, const std::function<DepthOf(double)>& depths,
             const std::function<Pose(double)>& hand,
             const std::function<void(double, const ToolContact&)>& see) {
    for (; 1e-3 * ticks_ < end - 1e-9; ++ticks_) {
      const double now = 1e-3 * ticks_;
      if (now >= kInterval * frames_) {
        source_.push(frame_of(small_camera(), now, depths(now), noise_, 7 + frames_),
                     [=] { return now + kLead; });
        ++frames_;
      }
      const Pose pose = hand(now);
      field_.update(now, pose, proxy_);
      const ToolContact contact = proxy_.step(field_, pose, kTick);
      ASSERT_TRUE(contact.wrench.force.allFinite() && contact.wrench.torque.allFinite());
      see(now, contact);
    }
  }

  // Takes the box down to `height` above z = 0 in the first second.
  static Pose lowered(double now, double height) {
    return pose_at({2e-3, 1e-3, std::max(height, 0.05 * (1 - now) + height)});
  }

  double noise_ = 0;
  Scene scene_;
  Source& source_ = scene_.add("camera", fitted_from(looking_down()));
  std::shared_ptr<const Tool> tool_ =
      std::make_shared<const Tool>(Tool::box({0.04, 0.06, 0.02}, 0.005));
  ToolField field_{scene_, tool_};
  ToolProxy proxy_{tool_, kOptions};
  long ticks_ = 0;
  int frames_ = 0;
};

DepthOf table(double /*now*/) {
  return wall(0.5);
}

// The noise of a structured light camera, 1.2 mm at 1 m, growing with the square.
TEST_F(ToolOnAStream, RestsOnANoisyTable) {
  noise_ = 0.3e-3;
  double step = 0;
  double turned = 0;
  int lost = 0;
  ToolContact last;
  until(
      3, table, [](double t) { return lowered(t, 6e-3); },
      [&](double t, const ToolContact& contact) {
        if (t > 1.2) {
          step = std::max(step, (contact.wrench.force - last.wrench.force).norm());
          turned = std::max(turned, (contact.wrench.torque - last.wrench.torque).norm());
          lost += contact.touching ? 0 : 1;
        }
        last = contact;
      });
  EXPECT_EQ(lost, 0);
  EXPECT_LT(step, 0.005);
  EXPECT_LT(turned, 5e-4);
  EXPECT_NEAR(last.wrench.force.z(), 500 * 4e-3, 0.2);
}

// A table that rises by 20 mm/s takes the box along: 0.01 N a tick.
TEST_F(ToolOnAStream, IsCarriedByATableThatRises) {
  const auto rising = [](double t) { return wall(0.5 - 0.02 * std::clamp(t - 1.5, 0.0, 0.5)); };
  double step = 0;
  double last = 0;
  until(
      3, rising, [](double t) { return lowered(t, 6e-3); },
      [&](double t, const ToolContact& contact) {
        if (t > 1.2) step = std::max(step, std::abs(contact.wrench.force.z() - last));
        last = contact.wrench.force.z();
      });
  EXPECT_LT(step, 0.02);
  EXPECT_NEAR(last, 500 * (4e-3 + 10e-3), 0.2);
}

// Slides over a ball of 80 mm and turns on it.
TEST_F(ToolOnAStream, SlidesAndTurnsOnABall) {
  const auto ball = [](double) {
    return seen_from_above([](double x, double y) {
      const double squared = x * x + y * y;
      return squared < 0.07 * 0.07 ? std::sqrt(0.08 * 0.08 - squared) - 0.08 : -0.041;
    });
  };
  noise_ = 0.2e-3;
  double step = 0;
  int lost = 0;
  Vector3d last = Vector3d::Zero();
  const auto hand = [](double t) {
    Pose pose = lowered(t, 6e-3);
    const double s = std::max(0.0, t - 1.2);
    pose.position += Vector3d(0.015 * std::sin(2 * s), 0.01 * std::sin(1.3 * s), 0);
    pose.orientation = Eigen::AngleAxisd(0.3 * std::sin(1.7 * s), Vector3d(1, 2, 3).normalized());
    return pose;
  };
  until(4, ball, hand, [&](double t, const ToolContact& contact) {
    if (t > 1.2) {
      step = std::max(step, (contact.wrench.force - last).norm());
      lost += contact.touching ? 0 : 1;
    }
    last = contact.wrench.force;
  });
  EXPECT_EQ(lost, 0);
  EXPECT_LT(step, 0.01);
}

// An arm passes between the camera and the table for a second, half a metre over the box.
TEST_F(ToolOnAStream, StaysOnATableThatIsHidden) {
  const auto hidden = [](double t) { return t > 1.5 && t < 2.5 ? wall(0.25) : wall(0.5); };
  double least = 1e9;
  until(
      3.5, hidden, [](double t) { return lowered(t, 6e-3); },
      [&](double t, const ToolContact& contact) {
        if (t > 1.2) least = std::min(least, contact.wrench.force.z());
      });
  EXPECT_GT(least, 1.7);
}

// The camera sees nothing more: its surface fades, and the tool goes to the hand. It comes back in
// front of the tool, which is behind it then and feels nothing, until it has come out.
TEST_F(ToolOnAStream, ASurfaceFadesAndComesBackSoftly) {
  const auto seen = [](double t) {
    return t > 1.5 && t < 4 ? DepthOf([](double, double) { return 0.0; }) : wall(0.5);
  };
  const auto hand = [](double t) {
    Pose pose = lowered(t, 6e-3);
    pose.position.z() += 0.03 * std::max(0.0, 1 - std::abs(t - 5.5) / 0.5);
    return pose;
  };
  double step = 0;
  double last = 0;
  double without = 0;
  until(7, seen, hand, [&](double t, const ToolContact& contact) {
    if (t > 1.2) step = std::max(step, std::abs(contact.wrench.force.z() - last));
    if (t > 3.5 && t < 5) without = std::max(without, contact.wrench.force.norm());
    last = contact.wrench.force.z();
  });
  EXPECT_LT(without, 1e-6);
  EXPECT_LT(step, 0.1);
  EXPECT_NEAR(last, 500 * 4e-3, 0.05);
}

// A step of the table by 30 mm above the box, which comes in one frame.
TEST_F(ToolOnAStream, ATableThatJumpsUpDoesNotStrike) {
  const auto jumping = [](double t) { return wall(t < 1.5 ? 0.5 : 0.47); };
  double most = 0;
  double step = 0;
  double last = 0;
  until(
      4, jumping, [](double t) { return lowered(t, 6e-3); },
      [&](double t, const ToolContact& contact) {
        if (t > 1.2) step = std::max(step, std::abs(contact.wrench.force.z() - last));
        most = std::max(most, contact.wrench.force.norm());
        last = contact.wrench.force.z();
      });
  EXPECT_LT(step, 0.6);
  EXPECT_LE(most, 500 * 0.034 + 0.01);
  EXPECT_NEAR(proxy_.pose().position.z(), 0.04, 1e-3);
}

}  // namespace
}  // namespace palpate::test
