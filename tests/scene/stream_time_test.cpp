// Checks surfaces in time: late, early and irregular frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/depth_frames.hpp"
#include "support/rates.hpp"
#include "support/stream_run.hpp"

namespace palpate {
namespace {

using test::kFrame;

using Eigen::Vector3d;
using test::frame_of;
using test::looking_down;
using test::small_camera;
using test::StreamRun;
using test::wall;

constexpr double kLead = 2e-3;
constexpr double kStiffness = 500;

class StreamTimeTest : public testing::Test {
 protected:
  static SourceOptions options() { return test::fitted_from(looking_down()); }

  // A frame of a plane at `height` that is ready at `ready` and felt a little later. From asking
  // for the start to publishing `rest` passes.
  void push(double stamp, double ready, double height, double rest = 0) {
    run_.at(ready + rest, [=, this] {
      source_.push(frame_of(small_camera(), stamp, wall(0.5 - height)),
                   [=] { return ready + kLead; });
    });
  }

  // Presses with a hand that is `depth` below z = 0 from the beginning; the largest change of
  // force from tick to tick after `from`, and the least force.
  void press(double from, double until, double depth) {
    const Vector3d hand(2e-3, 1e-3, -depth);
    double last = 0;
    run_.until(
        until, [&](double t) { return t < from - 0.1 ? Vector3d(0, 0, 0.03) : hand; },
        [&](double t, const Contact& contact) {
          const double force = contact.force.z();
          if (t > from) {
            step_ = std::max(step_, std::abs(force - last));
            least_ = std::min(least_, force);
            most_ = std::max(most_, force);
            lost_ += contact.touching ? 0 : 1;
          }
          last = force;
        });
    last_ = last;
  }

  Scene scene_;
  Source& source_ = scene_.add("camera", options());
  StreamRun run_{scene_};
  double step_ = 0;
  double least_ = 1e9;
  double most_ = 0;
  double last_ = 0;
  int lost_ = 0;
};

// A plane that rises at 2 cm/s. Its motion alone changes the force by 0.01 N a tick.
TEST_F(StreamTimeTest, FramesThatComeEarlyAndLateMakeNoStep) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.015, 0.015);
  double ready = 0;
  for (int k = 0; k < 60; ++k) {
    const double stamp = k * kFrame;
    ready = std::max(ready + 1e-4, stamp + 0.02 + jitter(random));
    push(stamp, ready, 0.02 * stamp);
  }
  press(0.3, 1.95, 5e-3);
  EXPECT_EQ(lost_, 0);
  EXPECT_LT(step_, 2.5 * kStiffness * 0.02e-3) << "a hard swap makes steps of 0.33 N";
}

// The same when publishing takes longer than the lead.
TEST_F(StreamTimeTest, FramesThatArePublishedLateMakeNoStep) {
  for (const double rest : {0.004, 0.008, 0.012}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-0.015, 0.015);
    Scene scene;
    Source& source = scene.add("camera", options());
    StreamRun run(scene);
    double ready = 0;
    for (int k = 0; k < 60; ++k) {
      const double stamp = k * kFrame;
      ready = std::max(ready + rest, stamp + 0.02 + jitter(random));
      run.at(ready + rest, [=, &source] {
        source.push(frame_of(small_camera(), stamp, wall(0.5 - 0.02 * stamp)),
                    [=] { return ready + kLead; });
      });
    }
    double last = 0;
    double step = 0;
    run.until(
        1.95, [](double t) { return Vector3d(0, 0, t < 0.2 ? 0.03 : -5e-3); },
        [&](double t, const Contact& contact) {
          if (t > 0.3) step = std::max(step, std::abs(contact.force.z() - last));
          last = contact.force.z();
        });
    EXPECT_LT(step, 3 * kStiffness * 0.02e-3) << rest;
  }
}

// What is kept goes on from where it is, however late it is kept.
TEST_F(StreamTimeTest, AKeptSurfaceStaysWhereItIs) {
  for (const double late : {0.005, 0.05, 0.2}) {
    Scene scene;
    Source& source = scene.add("camera", options());
    StreamRun run(scene);
    for (int k = 0; k < 15; ++k) {
      const double stamp = k * kFrame;
      run.at(stamp, [=, &source] {
        source.push(frame_of(small_camera(), stamp, wall(0.5 - 0.1 * stamp)),
                    [=] { return stamp; });
      });
    }
    run.at(14 * kFrame + late, [&] { source.keep(); });
    double last = 0;
    double step = 0;
    run.until(
        2, [](double t) { return Vector3d(0, 0, t < 0.1 ? 0.08 : 0.03); },
        [&](double t, const Contact& contact) {
          if (t > 0.45) step = std::max(step, std::abs(contact.force.z() - last));
          last = contact.force.z();
        });
    EXPECT_LT(step, 1.6 * kStiffness * 0.1e-3) << late;
    EXPECT_NEAR(last, kStiffness * (0.1 * 14 * kFrame - 0.03), 0.02) << "it does not fade";
  }
}

// One that had begun to fade regains its presence no faster than it fades.
TEST_F(StreamTimeTest, ASurfaceThatIsKeptTooLateComesBackSlowly) {
  for (int k = 0; k < 12; ++k) push(k * kFrame, k * kFrame, 0);
  run_.at(0.9, [this] { source_.keep(); });
  press(0.25, 1.8, 3e-3);
  EXPECT_LT(least_, 1.2);
  EXPECT_LT(step_, 0.01);
}

// What another camera sees stays as it is when one falls silent, 3 mm beside it.
TEST_F(StreamTimeTest, ASilentSensorLeavesTheSurfaceToTheOthers) {
  Scene scene;
  Source& first = scene.add("first", options());
  Source& other = scene.add("other", options());
  StreamRun run(scene);
  for (int k = 0; k < 70; ++k) {
    const double stamp = k * kFrame;
    run.at(stamp, [=, &first, &other] {
      const auto start = [=] { return stamp; };
      if (k < 15) first.push(frame_of(small_camera(), stamp, wall(0.497)), start);
      other.push(frame_of(small_camera(), stamp, wall(0.5)), start);
    });
  }
  double last = 0;
  double step = 0;
  double most = 0;
  run.until(
      2.2, [](double t) { return Vector3d(2e-3, 0, t < 0.1 ? 0.03 : -5e-3); },
      [&](double t, const Contact& contact) {
        if (t > 0.3) {
          step = std::max(step, (contact.force.norm() - last));
          step = std::max(step, (last - contact.force.norm()));
          most = std::max(most, contact.force.norm());
          EXPECT_GT(contact.force.norm(), 2.45) << t;
        }
        last = contact.force.norm();
      });
  EXPECT_NEAR(most, kStiffness * 6.5e-3, 0.1) << "between the two";
  EXPECT_NEAR(last, kStiffness * 5e-3, 0.02) << "that of the other alone";
  EXPECT_LT(step, 0.02);
}

TEST_F(StreamTimeTest, StampsThatAreIrregularMakeNoStepEither) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(-0.015, 0.015);
  double stamp = 0;
  for (int k = 0; k < 60; ++k) {
    stamp = std::max(stamp + 1e-4, k * kFrame + jitter(random));
    push(stamp, stamp + 0.008, 0.02 * stamp);
  }
  press(0.3, 1.95, 5e-3);
  EXPECT_EQ(lost_, 0);
  EXPECT_LT(step_, 2.5 * kStiffness * 0.02e-3);
}

TEST_F(StreamTimeTest, TwoFramesAtOnceMakeNoStep) {
  for (int k = 0; k < 40; ++k) {
    const double stamp = k * kFrame;
    push(stamp, stamp + (k % 5 == 3 ? kFrame : 0) + 0.01, 0.02 * stamp);
  }
  press(0.3, 1.3, 5e-3);
  EXPECT_EQ(lost_, 0);
  EXPECT_LT(step_, 2.5 * kStiffness * 0.02e-3);
}

TEST_F(StreamTimeTest, AGapHoldsTheSurfaceWhereItWas) {
  for (int k = 0; k < 12; ++k) push(k * kFrame, k * kFrame + 0.01, 0);
  for (int k = 18; k < 30; ++k) push(k * kFrame, k * kFrame + 0.01, 0);  // 0.2 s without a frame
  press(0.3, 0.95, 3e-3);
  EXPECT_EQ(lost_, 0);
  EXPECT_NEAR(least_, 1.5, 0.01);
  EXPECT_NEAR(most_, 1.5, 0.01);
}

// Published after its start: it begins where it should have begun, and never on its way.
TEST_F(StreamTimeTest, ASurfaceThatIsReadyTooLateMakesNoStep) {
  for (int k = 0; k < 40; ++k) {
    const double stamp = k * kFrame;
    run_.at(stamp + 0.012, [=, this] {
      source_.push(frame_of(small_camera(), stamp, wall(0.5 - 0.02 * stamp)),
                   [=] { return stamp + 0.002; });
    });
  }
  press(0.3, 1.3, 5e-3);
  EXPECT_EQ(lost_, 0);
  EXPECT_LT(step_, 2.5 * kStiffness * 0.02e-3);
}

TEST_F(StreamTimeTest, TheLagIsOneFrameAndTheLatency) {
  for (const double speed : {0.02, 0.10}) {
    Scene scene;
    Source& source = scene.add("camera", options());
    StreamRun run(scene);
    for (int k = 0; k < 30; ++k) {
      const double stamp = k * kFrame;
      run.at(stamp, [=, &source] {
        source.push(frame_of(small_camera(), stamp, wall(0.5 - speed * stamp)),
                    [=] { return stamp + 0.01; });
      });
    }
    double sum = 0;
    double largest = 0;
    int ticks = 0;
    run.until(
        0.95, [&](double t) { return Vector3d(0, 0, t < 0.1 ? 0.05 : -0.01); },
        [&](double t, const Contact& contact) {
          if (t < 0.3) return;
          EXPECT_TRUE(contact.touching) << t;
          const double lag = speed * t - contact.proxy.z();
          sum += lag;
          largest = std::max(largest, lag);
          ++ticks;
        });
    EXPECT_NEAR(sum / ticks, speed * (kFrame + 0.01), 0.03 * speed * kFrame) << speed;
    EXPECT_LT(largest, 1.1 * speed * (kFrame + 0.01)) << speed;
  }
}

TEST_F(StreamTimeTest, ASensorThatFallsSilentFadesWithoutAStep) {
  for (int k = 0; k < 12; ++k) push(k * kFrame, k * kFrame, 0);
  press(0.25, 1.6, 3e-3);
  EXPECT_NEAR(last_, 0, 1e-9);  // the last of a spring that fades
  EXPECT_NEAR(most_, 1.5, 0.01);
  // 1.5 N in half a second are 0.003 N a tick.
  EXPECT_LT(step_, 0.01);
  EXPECT_TRUE(run_.field().is_free({Vector3d::Zero(), 0.01}));
}

TEST_F(StreamTimeTest, ASensorThatComesBackIsFeltAgainWithoutAStep) {
  for (int k = 0; k < 12; ++k) push(k * kFrame, k * kFrame, 0);
  for (int k = 21; k < 60; ++k) push(k * kFrame, k * kFrame, 0);  // silent from 0.67 to 0.70 s
  press(0.25, 1.9, 3e-3);
  EXPECT_LT(least_, 1.45) << "it had begun to fade";
  EXPECT_NEAR(last_, 1.5, 0.02);
  EXPECT_LT(step_, 0.01);
}

}  // namespace
}  // namespace palpate
