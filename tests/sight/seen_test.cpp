// Checks what sources say is seen, and until when.
#include <gtest/gtest.h>

#include "palpate/scene/scene.hpp"
#include "support/depth_frames.hpp"

namespace palpate {
namespace {

using namespace test;
using Verdict = Seen::Verdict;

constexpr double kSeenPeriod = 0.03;  // s

TEST(Seen, IsThereFromTheFirstQuestionOn) {
  Scene scene;
  Source& source = scene.add("camera");
  const auto push = [&](double stamp) {
    return source.push(frame_of(small_camera(), stamp, wall(0.5)), [=] { return stamp + 0.02; });
  };
  const Ball ball{{0, 0, 0.4}, 0};
  EXPECT_FALSE(source.seen(ball, 0));
  ASSERT_TRUE(push(0));
  EXPECT_EQ(source.seen(ball, 0.01)->verdict, Verdict::free);
  ASSERT_TRUE(push(0.03));
  EXPECT_EQ(source.seen(ball, 0.08)->verdict, Verdict::free);
  EXPECT_EQ(source.seen(ball, 0.4)->verdict, Verdict::old);
}

TEST(Seen, LastsTwoAndAHalfIntervalsUntilItIsKnownWhenFramesAreDue) {
  constexpr double kDelay = 0.02;  // s
  Scene scene;
  Source& source = scene.add("camera");
  const Ball ball{{0, 0, 0.4}, 0};
  (void)source.seen(ball, 0);  // asks for frames
  double stamp = 0;
  for (int k = 0; k < 5; ++k) {
    stamp = k * kSeenPeriod;
    ASSERT_TRUE(
        source.push(frame_of(small_camera(), stamp, wall(0.5)), [&] { return stamp + kDelay; }));
    EXPECT_EQ(source.seen(ball, stamp + kDelay)->verdict, Verdict::free);
  }
  const double lasts = kDelay + 2.5 * kSeenPeriod;
  EXPECT_EQ(source.seen(ball, stamp + lasts - 1e-3)->verdict, Verdict::free);
  EXPECT_EQ(source.seen(ball, stamp + lasts + 1e-3)->verdict, Verdict::old);
}

TEST(Seen, IsTooOldOnceTheNextFrameIsDueHoweverManyAreLost) {
  constexpr double kDelay = 0.02;  // s
  Scene scene;
  Source& source = scene.add("camera");
  const Ball ball{{0, 0, 0.4}, 0};
  (void)source.seen(ball, 0);  // asks for frames
  double stamp = 0;
  for (int k = 0; k < 100; ++k) {
    if (k % 5 == 1 || k % 5 == 3) continue;
    stamp = k * kSeenPeriod;
    ASSERT_TRUE(source.push(frame_of(small_camera(), stamp, wall(0.5)), [&] { return stamp + 1; }));
    EXPECT_EQ(source.seen(ball, stamp + kDelay)->verdict, Verdict::free);
  }
  const double due = kSeenPeriod + kDelay;
  EXPECT_EQ(source.seen(ball, stamp + due - 1e-3)->verdict, Verdict::free);
  EXPECT_EQ(source.seen(ball, stamp + due + 1e-3)->verdict, Verdict::old);
}

TEST(Seen, LastsNoLongerAfterNobodyAskedForAWhile) {
  Scene scene;
  Source& source = scene.add("camera");
  const Ball ball{{0, 0, 0.4}, 0};
  (void)source.seen(ball, 0);  // asks for frames
  double stamp = 0;
  for (int k = 0; k < 60; ++k) {
    stamp = k * kSeenPeriod;
    ASSERT_TRUE(source.push(frame_of(small_camera(), stamp, wall(0.5)), [&] { return stamp; }));
    if (k < 30 || k > 50) (void)source.seen(ball, stamp);
    if (k == 50) (void)source.seen(ball, stamp + 0.9 * kSeenPeriod);
  }
  EXPECT_EQ(source.seen(ball, stamp + kSeenPeriod + 1e-3)->verdict, Verdict::old);
}

TEST(Seen, OfAStreamThatHasEndedIsTooOldAsOfOneThatIsSilent) {
  Scene scene;
  Source& source = scene.add("camera");
  const Ball ball{{0, 0, 0.4}, 0};
  (void)source.seen(ball, 0);  // asks for frames
  for (const double stamp : {0., 0.03}) {
    ASSERT_TRUE(source.push(frame_of(small_camera(), stamp, wall(0.5)), [=] { return stamp; }));
  }
  source.keep();
  EXPECT_EQ(source.seen(ball, 0.08)->verdict, Verdict::free);
  EXPECT_EQ(source.seen(ball, 0.4)->verdict, Verdict::old) << "what is felt stays";
}

TEST(Seen, OfAFrameThatStaysIsNeverTooOld) {
  Scene scene;
  Source& source = scene.add("image");
  source.set(frame_of(small_camera(), 0, wall(0.5)));
  EXPECT_EQ(source.seen({{0, 0, 0.4}, 0}, 1e6)->verdict, Verdict::free);
  EXPECT_EQ(source.seen({{0, 0, 0.52}, 0}, 1e6)->verdict, Verdict::solid);
  source.keep();
  EXPECT_EQ(source.seen({{0, 0, 0.4}, 0}, 1e6)->verdict, Verdict::free);
}

TEST(Seen, IsNothingOfClouds) {
  Scene scene;
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.positions.emplace_back(0.01f * static_cast<float>(i % 20),
                                 0.01f * static_cast<float>(i / 20), 0);
  }
  EXPECT_FALSE(scene.add("cloud", cloud).seen(Ball{}, 0));
}

}  // namespace
}  // namespace palpate
