#include "palpate/sensor/stream.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <thread>
#include <vector>

#include "sensor/stream_fixture.hpp"

namespace palpate {
namespace {

using namespace sensor;

TEST_F(StreamTest, MakesFramesTouchableWithALead) {
  const Stream stream = this->stream({.lead = 0.25, .stall = kNever});
  EXPECT_EQ(stream.state().phase, StreamState::Phase::starting);
  give(stream, 1);
  expect_touchable(stream, 1);
  give(stream, 1.5, frame_at(1.25, 7));
  expect_touchable(stream, 2);
  EXPECT_EQ(touchable_.stamps(), (std::vector{1.0, 1.25}));
  EXPECT_EQ(touchable_.starts(), (std::vector{1.25, 1.75}));
  const StreamState state = stream.state();
  EXPECT_EQ(state.source, "table");
  EXPECT_EQ(state.camera, "fake");
  EXPECT_EQ(state.phase, StreamState::Phase::running);
  EXPECT_EQ(state.frames, 2u);
  EXPECT_EQ(state.drops.total(), 0u);
  EXPECT_DOUBLE_EQ(state.latency_mean, (0.25 + 0.5) / 2);
  EXPECT_DOUBLE_EQ(state.latency_worst, 0.5);
  EXPECT_TRUE(state.problem.empty()) << state.problem;
}

TEST_F(StreamTest, DropsWhatIsOvertakenAndNeverQueues) {
  touchable_.close();
  const Stream stream = this->stream();
  give(stream, 1);
  ASSERT_TRUE(eventually([&] { return touchable_.entered() == 1; }));
  for (int i = 2; i <= 5; ++i) give(stream, i);
  EXPECT_EQ(stream.state().drops.overtaken, 3u);
  touchable_.open();
  expect_touchable(stream, 2);
  EXPECT_EQ(touchable_.stamps(), (std::vector{1.0, 5.0}));
}

TEST_F(StreamTest, LosesNothingOfACameraThatDoesNotPace) {
  const Stream stream = this->stream({.stall = kNever}, false);
  std::vector<double> stamps;
  for (int i = 1; i <= 50; ++i) {
    stamps.push_back(i);
    script_->give({.frame = frame_at(i, static_cast<float>(i))});
  }
  script_->give({.status = DepthCamera::Status::ended});
  EXPECT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::ended; }));
  EXPECT_EQ(touchable_.stamps(), stamps);
  EXPECT_EQ(stream.state().drops.total(), 0u);
}

TEST_F(StreamTest, TakesRepeatsForRealWhereTheCameraOrTheUserSaysSo) {
  const auto dropped = [&](bool camera, std::optional<bool> user) {
    const Stream stream(this->camera(true, camera), "table", touchable_.sink(), clock_,
                        {.stall = kNever, .allow_repeats = user});
    const double now = clock_.now();
    for (int i = 1; i <= 3; ++i) give(stream, now + i, frame_at(now + i, 2));
    return stream.state().drops.repeated;
  };
  EXPECT_EQ(dropped(false, {}), 2u);
  EXPECT_EQ(dropped(true, {}), 0u);
  EXPECT_EQ(dropped(false, true), 0u);
  EXPECT_EQ(dropped(true, false), 2u);
}

TEST_F(StreamTest, LetsTheCameraBeginWhenItDoesOrWhenItIsTold) {
  clock_.set(7);
  const Stream now = this->stream();
  EXPECT_EQ(cameras_.back().begun(), 7);
  const Stream told = this->stream({.start = 6.5});
  EXPECT_EQ(cameras_.back().begun(), 6.5);
}

TEST_F(StreamTest, FramesInABunchAreNoHigherRate) {
  const Stream stream = this->stream();
  for (int bunch = 0; bunch < 6; ++bunch) {
    for (int i = 0; i < 10; ++i) give(stream, bunch / 3. + 1e-3 * i);  // 30 a second
  }
  EXPECT_NEAR(stream.state().rate, 30, 8);
}

TEST_F(StreamTest, SaysTheRate) {
  const Stream stream = this->stream();
  for (int i = 0; i <= 10; ++i) give(stream, 0.125 * i);
  EXPECT_DOUBLE_EQ(stream.state().rate, 8);
  clock_.set(clock_.now() + 10);
  EXPECT_DOUBLE_EQ(stream.state().rate, 0.1) << "of a camera that is silent";
}

TEST_F(StreamTest, EndsWhenTheLastFrameIsPrepared) {
  touchable_.close();
  const Stream stream = this->stream();
  give(stream, 1);
  script_->give({.status = DepthCamera::Status::ended});
  ASSERT_TRUE(eventually([&] { return script_->pending() == 0; }));
  EXPECT_NE(stream.state().phase, StreamState::Phase::ended);
  touchable_.open();
  EXPECT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::ended; }));
  EXPECT_EQ(touchable_.stamps(), std::vector{1.0});
  clock_.set(100);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::ended) << "the end is no stall";
}

TEST_F(StreamTest, TellsOfTheEndAfterTheLastFrame) {
  std::atomic<std::size_t> pushed_at_end{99};
  const Stream stream(camera(), "table", touchable_.sink(), clock_, {},
                      [&] { pushed_at_end = touchable_.stamps().size(); });
  give(stream, 0.1);
  script_->give({.status = DepthCamera::Status::ended});
  ASSERT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::ended; }));
  EXPECT_EQ(pushed_at_end, 1u);
}

TEST_F(StreamTest, StopsInEveryState) {
  { const Stream starting = this->stream(); }
  {
    const Stream failing = this->stream({.first_retry = 1e6, .longest_retry = 1e6});
    script_->give({.status = DepthCamera::Status::failed, .reason = "a"});
    script_->give({.status = DepthCamera::Status::failed, .reason = "b"});
    ASSERT_TRUE(eventually([&] { return failing.state().failures == 2; }));
  }
  {
    const Stream ended = this->stream();
    script_->give({.status = DepthCamera::Status::ended});
    ASSERT_TRUE(eventually([&] { return ended.state().phase == StreamState::Phase::ended; }));
  }
  {
    Stream moved = this->stream();
    const Stream taker = std::move(moved);
    give(taker, 1);
  }
  {
    touchable_.close();
    const Stream lossless = this->stream({.stall = kNever}, false);
    for (int i = 2; i < 9; ++i) script_->give({.frame = frame_at(i, static_cast<float>(i))});
    ASSERT_TRUE(eventually([&] { return lossless.state().frames >= 2; }));
    touchable_.open();
  }
}

TEST_F(StreamTest, RefusesSenselessOptions) {
  EXPECT_THROW((void)stream({.lead = -1}), Error);
  EXPECT_THROW((void)stream({.stall = 0}), Error);
  EXPECT_THROW((void)stream({.patience = std::nan("")}), Error);
  EXPECT_THROW((void)stream({.first_retry = 2, .longest_retry = 1}), Error);
  EXPECT_THROW((void)stream({.start = std::nan("")}), Error);
}

TEST_F(StreamTest, ManyLookOnWhileItRuns) {
  const Stream stream = this->stream({.stall = kNever}, false);
  std::vector<std::thread> observers;
  for (int i = 0; i < 3; ++i) {
    observers.emplace_back([&] {
      while (stream.state().phase != StreamState::Phase::ended) std::this_thread::yield();
    });
  }
  for (int i = 1; i <= 200; ++i) script_->give({.frame = frame_at(i, static_cast<float>(i))});
  script_->give({.status = DepthCamera::Status::ended});
  for (std::thread& observer : observers) observer.join();
  EXPECT_EQ(stream.state().touchable, 200u);
}

}  // namespace
}  // namespace palpate
