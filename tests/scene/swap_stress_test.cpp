// Swaps snapshots under a moving field on several threads.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/depth_frames.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

const CameraModel kTinyCamera{48, 36, {110, 110, 23.5, 17.5}, {}};

// What a thread that touches the scene found.
struct Touched {
  int steps = 0;
  int infinite = 0;
  int outside = 0;  // places where the surface never was
};

class SwapStressTest : public testing::Test {
 protected:
  static SourceOptions options() {
    SourceOptions options;
    options.T_world_sensor = test::looking_down();
    return options;
  }

  // A wall that rises and falls by 2 mm.
  static std::vector<DepthFrame> frames() {
    std::vector<DepthFrame> frames;
    for (int k = 0; k < 8; ++k) {
      frames.push_back(test::frame_of(kTinyCamera, 0, test::wall(0.5 + 2e-3 * std::sin(0.785 * k)),
                                      2e-4, static_cast<unsigned>(k)));
    }
    return frames;
  }

  // Touches the scene until told to stop. Time is the publisher's.
  Touched touch(SceneField& field) {
    Proxy proxy;
    Touched touched;
    for (int k = 0; !done_; ++k) {
      const double now = now_;
      const Vector3d hip(4e-3 * std::sin(0.01 * k), 0, k < 5 ? 20e-3 : -4e-3);
      field.update(now, hip, proxy);
      const Contact contact = proxy.step(field, hip, 1e-3);
      const bool finite = contact.force.allFinite() && contact.proxy.allFinite();
      touched.infinite += finite ? 0 : 1;
      touched.outside += contact.touching && std::abs(contact.proxy.z()) > 4e-3 ? 1 : 0;
      ++touched.steps;
    }
    return touched;
  }

  Scene scene_;
  Source& source_ = scene_.add("camera", options());
  std::atomic<bool> done_{false};
  std::atomic<double> now_{0};
};

// A thousand frames a second into one source; two servos touch it and a third reader stands still.
TEST_F(SwapStressTest, AThousandSwapsASecondWithAStuckReader) {
  const int count = test::effort(3000);
  std::vector<DepthFrame> all = frames();
  SceneField stuck(scene_, {}, "stuck viewer");
  SceneField first(scene_, {}, "first");
  SceneField second(scene_, {}, "second");
  std::array<Touched, 2> touched;
  int pushed = 0;
  {
    const std::jthread a([&] { touched[0] = touch(first); });
    const std::jthread b([&] { touched[1] = touch(second); });
    auto next = std::chrono::steady_clock::now();
    for (int k = 0; k < count; ++k) {
      DepthFrame& frame = all[static_cast<std::size_t>(k) % all.size()];
      frame.stamp = 1e-3 * k;
      now_ = frame.stamp;
      pushed += source_.push(frame, [&] { return frame.stamp + 5e-4; }) ? 1 : 0;
      if (k == 3) stuck.update_from(frame.stamp, Vector3d::Zero(), Vector3d::Zero());
      static_cast<void>(scene_.state(0));
      std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
    }
    done_ = true;
  }
  for (const Touched& each : touched) {
    EXPECT_GT(each.steps, 10);
    EXPECT_EQ(each.infinite, 0);
    EXPECT_EQ(each.outside, 0);
  }
  const Source::State state = source_.state();
  EXPECT_EQ(state.frames, static_cast<std::uint64_t>(pushed));
  EXPECT_EQ(state.frames + state.dropped, static_cast<std::uint64_t>(count));
  EXPECT_GT(pushed, 10) << "a reader that stands still delays nobody";
}

// Sources come by pointer: those who draw them keep them as long as they like.
TEST_F(SwapStressTest, PointsMayBeKeptWhileFramesGoOn) {
  std::vector<DepthFrame> all = frames();
  std::vector<std::shared_ptr<const SurfacePoints>> kept;
  std::atomic<int> odd{0};
  {
    const std::jthread drawing([&] {
      while (!done_) {
        const auto points = source_.points();
        if (!points) continue;
        double sum = 0;
        for (const auto& p : points->grid.points()) sum += static_cast<double>(p.z());
        if (!std::isfinite(sum)) ++odd;
      }
    });
    for (int k = 0; k < test::effort(500); ++k) {
      DepthFrame& frame = all[static_cast<std::size_t>(k) % all.size()];
      frame.stamp = 1e-3 * k;
      ASSERT_TRUE(source_.push(frame, [&] { return frame.stamp; }));
      if (k % 20 == 0) kept.push_back(source_.points());
    }
    done_ = true;
  }
  EXPECT_EQ(odd, 0);
  for (const auto& points : kept) EXPECT_EQ(points->size(), points->radii.size());
}

TEST_F(SwapStressTest, NamesTheReaderThatHoldsEverything) {
  std::vector<DepthFrame> all = frames();
  SceneField stuck(scene_, {}, "stuck viewer");
  SceneField other(scene_, {}, "other viewer");
  double now = 0;
  const auto push = [&] {
    all[0].stamp = now += 0.03;
    return source_.push(all[0], [&] { return now + 0.02; });
  };
  // Each takes one to show and one that waits, all of them different.
  for (SceneField* field : {&stuck, &other}) {
    push();
    field->update_from(now + 0.021, Vector3d::Zero(), Vector3d::Zero());
    push();
    field->update_from(now - 0.001, Vector3d::Zero(), Vector3d::Zero());
  }
  EXPECT_TRUE(push());
  // Two each and the newest: with N = 1 and two fields there are no more than five.
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(push());
  EXPECT_EQ(source_.state().dropped, 5u);
  EXPECT_EQ(source_.state().slowest, "stuck viewer");
  stuck.update_from(now + 1, Vector3d::Zero(), Vector3d::Zero());
  stuck.update_from(now + 1, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(push());
}

}  // namespace
}  // namespace palpate
