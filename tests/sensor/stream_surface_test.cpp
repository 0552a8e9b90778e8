// What a hand on a surface feels of a camera that stops, freezes, fails or changes: from the camera
// through a stream and a scene to the proxy's force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "palpate/sensor/stream.hpp"
#include "sensor/fake_camera.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"
#include "support/stream_run.hpp"

namespace palpate {
namespace {

using test::kFrame;

using namespace sensor;
using Eigen::Vector3d;
using test::StreamRun;

constexpr double kLead = 2e-3;
constexpr double kSilence = 0.3;
constexpr double kFade = 0.4;
constexpr double kStall = 0.2;
constexpr double kDepth = 3e-3;  // of the hand below the surface, m
constexpr double kForce = 500 * kDepth;
// A fade takes kForce in kFade: 3.75 mN a tick. A hard end would be 1.5 N.
constexpr double kNoStep = 0.01;
constexpr double kGone = 2;     // s; by then nothing is left of what fades
constexpr double kAgain = 2.5;  // when the hand presses again, s

SourceOptions watched() {
  SourceOptions options;
  options.T_world_sensor = test::looking_down();
  options.policy.fit_everywhere = true;
  options.policy.silence = kSilence;
  options.policy.fade = kFade;
  return options;
}

// Blocks are 5.3 mm apart on a surface 0.5 m away.
CameraModel camera() {
  return {80, 60, {187.5, 187.5, 39.5, 29.5}, {}};
}
// The same camera with other pixels.
CameraModel other_camera() {
  return {96, 72, {225, 225, 47.5, 35.5}, {}};
}

// A camera sees the plane z = 0 while a hand presses 3 mm into it; the test's clock is the servo's,
// the stream's and the hand's.
class StreamSurfaceTest : public testing::Test {
 protected:
  // The plane, with noise far below what is felt, so that no two pictures are the same.
  [[nodiscard]] DepthFrame plane(double stamp, const CameraModel& model = camera()) {
    return test::frame_of(model, stamp, test::wall(0.5), 1e-6, ++pictures_);
  }

  // At time `t` the camera delivers `frame`, which becomes touchable or is dropped.
  void deliver(double t, const DepthFrame& frame) {
    run_.at(t, [=, this] {
      const StreamState before = stream_.state();
      clock_.set(t);
      script_->give({.frame = frame});
      EXPECT_TRUE(eventually([&] {
        const StreamState now = stream_.state();
        return now.touchable + now.drops.total() > before.touchable + before.drops.total();
      })) << t;
    });
  }
  void deliver_planes(int first, int last) {
    for (int k = first; k <= last; ++k) deliver(k * kFrame, plane(k * kFrame));
  }

  // At time `t` the camera answers something else than a frame, and the stream notes it.
  void answer(double t, DepthCamera::Status status) {
    run_.at(t, [=, this] {
      clock_.set(t);
      script_->give({.status = status, .reason = "unplugged"});
      const auto noted = [&] {
        const StreamState now = stream_.state();
        return now.failures > failures_ || now.phase == StreamState::Phase::ended;
      };
      EXPECT_TRUE(eventually(noted)) << t;
      failures_ = stream_.state().failures;
    });
  }

  // Presses from 0.2 s on, lifts after kGone and presses again, and remembers what there is to feel
  // after `from`.
  void press(double until, double from = 0.4) {
    least_ = 1e9;
    most_ = 0;
    step_ = 0;
    run_.until(
        until,
        [&](double t) {
          clock_.set(t);
          const bool lifted = t < 0.2 || (t > kGone && t < kAgain);
          return Vector3d(2e-3, 1e-3, lifted ? 0.02 : -kDepth);
        },
        [&](double t, const Contact& contact) { feel(contact, t > from); });
  }

  void feel(const Contact& contact, bool counts) {
    const double force = contact.force.z();
    EXPECT_TRUE(contact.force.allFinite());
    EXPECT_FALSE(has(contact.notes, ContactNote::fault));
    if (counts) {
      least_ = std::min(least_, force);
      most_ = std::max(most_, force);
      step_ = std::max(step_, std::abs(force - last_));
    }
    last_ = force;
  }

  // Fades as it should when nothing of use has come since the last frame before `t`.
  void expect_fading_after(double t) {
    press(t + kSilence - 2 * kFrame);
    EXPECT_NEAR(least_, kForce, 0.01 * kForce) << "it began to fade too early";
    EXPECT_LT(step_, kNoStep);
    press(t + kSilence + kFade / 2 + kLead);
    EXPECT_NEAR(last_, kForce / 2, 0.15 * kForce) << "half of the fade";
    EXPECT_LT(step_, kNoStep);
    press(t + kSilence + kFade + 2 * kFrame);
    EXPECT_LT(last_, 0.01 * kForce) << "it has faded";
    EXPECT_LT(step_, kNoStep);
    press(kGone);
    EXPECT_EQ(last_, 0);
    EXPECT_TRUE(run_.field().is_free({Vector3d::Zero(), 0.01}));
  }

  Scene scene_;
  Source& source_ = scene_.add("camera", watched());
  ManualClock clock_;
  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  FakeCamera camera_{script_};
  Stream stream_{camera_,
                 source_,
                 clock_,
                 {.lead = kLead,
                  .stall = kStall,
                  .patience = 5e-3,
                  .first_retry = 1e-3,
                  .longest_retry = 1e-3}};
  StreamRun run_{scene_};
  unsigned pictures_ = 0;
  std::uint64_t failures_ = 0;
  double least_ = 0;
  double most_ = 0;
  double step_ = 0;
  double last_ = 0;
};

constexpr int kGood = 18;  // frames before the trouble
constexpr double kTrouble = kGood * kFrame;

TEST_F(StreamSurfaceTest, IsSteadyWhileFramesCome) {
  deliver_planes(0, 45);
  press(1.55);
  EXPECT_NEAR(least_, kForce, 0.01 * kForce);
  EXPECT_NEAR(most_, kForce, 0.01 * kForce);
  EXPECT_LT(step_, kNoStep);
  EXPECT_EQ(stream_.state().touchable, 46u);
  EXPECT_DOUBLE_EQ(stream_.state().latency_worst, kLead);
}

TEST_F(StreamSurfaceTest, FadesWhenTheCameraStops) {
  deliver_planes(0, kGood);
  expect_fading_after(kTrouble);
  EXPECT_EQ(stream_.state().phase, StreamState::Phase::stalled);
  EXPECT_EQ(stream_.state().stalls, 1u);
}

TEST_F(StreamSurfaceTest, FadesWhenThePictureFreezes) {
  deliver_planes(0, kGood);
  DepthFrame frozen = plane(kTrouble);
  for (int k = kGood; k < 45; ++k) {
    frozen.stamp = (k + 0.5) * kFrame;
    deliver(frozen.stamp, frozen);
  }
  expect_fading_after(kTrouble + kFrame / 2);
  EXPECT_EQ(stream_.state().phase, StreamState::Phase::stalled);
  EXPECT_GT(stream_.state().drops.repeated, 20u);
}

TEST_F(StreamSurfaceTest, FadesWhenTheCameraIsUnpluggedAndComesBackWithIt) {
  deliver_planes(0, kGood);
  for (int i = 0; i < 20; ++i) answer(kTrouble + 0.01 + 0.05 * i, DepthCamera::Status::failed);
  deliver_planes(67, 99);
  expect_fading_after(kTrouble);
  EXPECT_NE(stream_.state().phase, StreamState::Phase::running);
  // Whichever was noticed last: that it is unplugged, or that no frame came for so long.
  EXPECT_EQ(stream_.state().problem.find("camera (fake): "), 0u) << stream_.state().problem;
  press(3.3, 2.6);
  EXPECT_NEAR(least_, kForce, 0.01 * kForce) << "it is back";
  EXPECT_LT(step_, kNoStep);
  EXPECT_EQ(stream_.state().phase, StreamState::Phase::running);
}

TEST_F(StreamSurfaceTest, FadesWhenOnlyGarbageComes) {
  deliver_planes(0, kGood);
  for (int k = kGood + 1; k < 45; ++k) {
    DepthFrame frame = plane(k * kFrame);
    if (k % 3 == 0) frame.depth.resize(7);
    if (k % 3 == 1) std::ranges::fill(frame.depth, 0.0F);
    if (k % 3 == 2) frame.camera.pinhole.fx = std::nan("");
    deliver(k * kFrame, frame);
  }
  expect_fading_after(kTrouble);
  EXPECT_EQ(stream_.state().phase, StreamState::Phase::stalled);
  EXPECT_GT(stream_.state().drops.garbage, 10u);
  EXPECT_GT(stream_.state().drops.empty, 5u);
}

TEST_F(StreamSurfaceTest, FeelsNothingOfAFewFramesOfAnotherSize) {
  deliver_planes(0, kGood);
  for (int k = kGood + 1; k < kGood + 3; ++k) {
    deliver(k * kFrame, plane(k * kFrame, other_camera()));
  }
  deliver_planes(kGood + 3, 45);
  press(1.5);
  EXPECT_NEAR(least_, kForce, 0.01 * kForce);
  EXPECT_LT(step_, kNoStep);
  EXPECT_EQ(stream_.state().drops.resized, 2u);
}

TEST_F(StreamSurfaceTest, GoesOverToAnotherSizeWithoutAStep) {
  deliver_planes(0, kGood);
  for (int k = kGood + 1; k < 50; ++k) deliver(k * kFrame, plane(k * kFrame, other_camera()));
  press(1.6);
  EXPECT_NEAR(least_, kForce, 0.1 * kForce);
  EXPECT_NEAR(last_, kForce, 0.02 * kForce);
  EXPECT_LT(step_, kNoStep);
  EXPECT_EQ(stream_.state().size_changes, 1u);
}

TEST_F(StreamSurfaceTest, GoesOverToASmallerSizeWithoutAStep) {
  for (int k = 0; k <= kGood; ++k) deliver(k * kFrame, plane(k * kFrame, other_camera()));
  for (int k = kGood + 1; k < 50; ++k) deliver(k * kFrame, plane(k * kFrame));
  press(1.6);
  EXPECT_NEAR(least_, kForce, 0.1 * kForce);
  EXPECT_NEAR(last_, kForce, 0.02 * kForce);
  EXPECT_LT(step_, kNoStep);
  EXPECT_EQ(stream_.state().size_changes, 1u);
}

TEST_F(StreamSurfaceTest, KeepsWhatARecordingShowedLast) {
  deliver_planes(0, kGood);
  answer(kTrouble + kFrame, DepthCamera::Status::ended);
  press(kGone);
  EXPECT_NEAR(least_, kForce, 0.01 * kForce);
  EXPECT_LT(step_, kNoStep);
  press(4.3, 2.6);
  EXPECT_NEAR(least_, kForce, 0.01 * kForce);
}

}  // namespace
}  // namespace palpate
