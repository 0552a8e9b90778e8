#include "palpate/sensor/stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "palpate/base/error.hpp"
#include "sensor/fake_camera.hpp"

namespace palpate {
namespace {

using namespace sensor;

// What is pushed, with a gate before it.
class Touchable {
 public:
  [[nodiscard]] FrameSink sink() {
    return [this](const DepthFrame& frame, const StartTime& start) { push(frame, start); };
  }
  void close() { open(false); }
  void open(bool is_open = true) {
    const std::lock_guard lock(mutex_);
    open_ = is_open;
    changed_.notify_all();
  }
  void throw_next(const std::string& what) {
    const std::lock_guard lock(mutex_);
    failure_ = what;
  }
  [[nodiscard]] std::size_t entered() {
    const std::lock_guard lock(mutex_);
    return entered_;
  }
  [[nodiscard]] std::vector<double> stamps() {
    const std::lock_guard lock(mutex_);
    return stamps_;
  }
  [[nodiscard]] std::vector<double> starts() {
    const std::lock_guard lock(mutex_);
    return starts_;
  }

 private:
  void push(const DepthFrame& frame, const StartTime& start) {
    std::unique_lock lock(mutex_);
    ++entered_;
    changed_.wait(lock, [this] { return open_; });
    if (!failure_.empty()) throw Error(std::exchange(failure_, ""));
    stamps_.push_back(frame.stamp);
    starts_.push_back(start());
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = true;
  std::string failure_;
  std::size_t entered_ = 0;
  std::vector<double> stamps_;
  std::vector<double> starts_;
};

class StreamTest : public testing::Test {
 protected:
  // The clock jumps in these tests; that is no stall unless a test says so.
  static constexpr double kNever = 1e9;

  [[nodiscard]] Stream stream(const StreamOptions& options = {.stall = kNever}, bool paces = true) {
    return {std::make_unique<FakeCamera>(script_, paces), "table", touchable_.sink(), clock_,
            options};
  }

  // Gives the frame of time `t` and waits until the stream has seen it.
  void give(const Stream& stream, double t, DepthFrame frame) {
    const auto before = stream.state().frames;
    clock_.set(t);
    script_->give({.frame = std::move(frame)});
    ASSERT_TRUE(eventually([&] { return stream.state().frames == before + 1; }));
  }
  void give(const Stream& stream, double t) {
    give(stream, t, frame_at(t, static_cast<float>(1 + t)));
  }
  void expect_touchable(const Stream& stream, std::uint64_t count) {
    EXPECT_TRUE(eventually([&] { return stream.state().touchable == count; }))
        << stream.state().touchable;
  }

  // The clock goes on by `seconds` and the stream looks at it.
  void pass(const Stream& stream, double seconds) {
    clock_.set(clock_.now() + seconds);
    const int before = script_->reads();
    ASSERT_TRUE(eventually([&] { return script_->reads() > before + 1; })) << stream.state().frames;
  }

  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  Touchable touchable_;
  ManualClock clock_;
};

TEST_F(StreamTest, MakesFramesTouchableWithALead) {
  const Stream stream = this->stream({.lead = 0.25, .stall = kNever});
  EXPECT_EQ(stream.state().phase, StreamPhase::starting);
  give(stream, 1);
  expect_touchable(stream, 1);
  give(stream, 1.5, frame_at(1.25, 7));
  expect_touchable(stream, 2);
  EXPECT_EQ(touchable_.stamps(), (std::vector{1.0, 1.25}));
  EXPECT_EQ(touchable_.starts(), (std::vector{1.25, 1.75}));
  const StreamState state = stream.state();
  EXPECT_EQ(state.source, "table");
  EXPECT_EQ(state.camera, "fake");
  EXPECT_EQ(state.phase, StreamPhase::running);
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
  script_->give({.status = CameraStatus::ended});
  EXPECT_TRUE(eventually([&] { return stream.state().phase == StreamPhase::ended; }));
  EXPECT_EQ(touchable_.stamps(), stamps);
  EXPECT_EQ(stream.state().drops.total(), 0u);
}

TEST_F(StreamTest, SaysTheRate) {
  const Stream stream = this->stream();
  for (int i = 0; i <= 10; ++i) give(stream, 0.125 * i);
  EXPECT_DOUBLE_EQ(stream.state().rate, 8);
  clock_.set(clock_.now() + 10);
  EXPECT_DOUBLE_EQ(stream.state().rate, 0.1) << "of a camera that is silent";
}

TEST_F(StreamTest, NoticesSilence) {
  const Stream stream = this->stream({.stall = 0.5});
  give(stream, 0.1);
  pass(stream, 0.4);
  EXPECT_EQ(stream.state().phase, StreamPhase::running);
  pass(stream, 0.2);
  EXPECT_EQ(stream.state().phase, StreamPhase::stalled);
  pass(stream, 5);
  EXPECT_EQ(stream.state().stalls, 1u) << "one silence, one stall";
  EXPECT_EQ(stream.state().problem, "table (fake): no frame for 0.6 s");
  EXPECT_DOUBLE_EQ(stream.state().problem_at, 0.7);
  give(stream, 7);
  EXPECT_EQ(stream.state().phase, StreamPhase::running);
}

TEST_F(StreamTest, NoticesACameraThatNeverDelivers) {
  const Stream stream = this->stream({.stall = 0.5});
  pass(stream, 0.6);
  EXPECT_EQ(stream.state().phase, StreamPhase::stalled);
}

TEST_F(StreamTest, NoticesAFrozenPicture) {
  const Stream stream = this->stream({.stall = 0.5});
  for (int i = 0; i <= 8; ++i) give(stream, 0.125 * i, frame_at(0.125 * i, 2));
  expect_touchable(stream, 1);
  const StreamState state = stream.state();
  EXPECT_EQ(state.phase, StreamPhase::stalled);
  EXPECT_EQ(state.stalls, 1u);
  EXPECT_EQ(state.drops.repeated, 8u);
  EXPECT_NE(state.problem.find("repeats"), std::string::npos) << state.problem;
}

TEST_F(StreamTest, CountsGarbageAndGoesOn) {
  const Stream stream = this->stream();
  give(stream, 1);
  expect_touchable(stream, 1);  // or a later one might overtake it
  DepthFrame cut = frame_at(2);
  cut.depth.resize(5);
  give(stream, 2, cut);
  give(stream, 3, frame_at(3, 0));
  give(stream, 4, frame_at(3.5, 5, 8, 6));
  give(stream, 5, frame_at(1, 5));
  give(stream, 6);
  expect_touchable(stream, 2);
  const StreamDrops drops = stream.state().drops;
  EXPECT_EQ(drops.garbage, 1u);
  EXPECT_EQ(drops.empty, 1u);
  EXPECT_EQ(drops.resized, 1u);
  EXPECT_EQ(drops.late, 1u);
  EXPECT_EQ(drops.total(), 4u);
  EXPECT_EQ(stream.state().frames, 6u);
}

TEST_F(StreamTest, TakesAnotherSizeThatLasts) {
  const Stream stream = this->stream();
  give(stream, 1);
  expect_touchable(stream, 1);
  for (int i = 2; i <= 4; ++i) give(stream, i, frame_at(i, static_cast<float>(i), 8, 6));
  expect_touchable(stream, 2);
  EXPECT_EQ(stream.state().size_changes, 1u);
  EXPECT_NE(stream.state().problem.find("size"), std::string::npos) << stream.state().problem;
}

TEST_F(StreamTest, SurvivesPreparationThatThrows) {
  const Stream stream = this->stream();
  touchable_.throw_next("it is all too much");
  give(stream, 1);
  ASSERT_TRUE(eventually([&] { return stream.state().drops.refused == 1; }));
  EXPECT_EQ(stream.state().problem,
            "table (fake): a frame could not be prepared: it is all too much");
  give(stream, 2);
  expect_touchable(stream, 1);
}

TEST_F(StreamTest, AsksACameraThatFailsEverMoreRarely) {
  const Stream stream = this->stream({.stall = kNever, .first_retry = 1, .longest_retry = 3});
  const auto fail = [&](std::uint64_t failures) {
    script_->give({.status = CameraStatus::failed, .reason = "unplugged"});
    return eventually([&] { return stream.state().failures == failures; });
  };
  const auto retried = [&](std::uint64_t retries) {
    return eventually([&] { return stream.state().retries == retries; });
  };
  ASSERT_TRUE(fail(1));
  ASSERT_TRUE(retried(1)) << "at once: one frame may be broken";
  EXPECT_EQ(stream.state().phase, StreamPhase::starting);
  std::uint64_t count = 1;
  for (const double wait : {1.0, 2.0, 3.0, 3.0}) {
    ASSERT_TRUE(fail(++count));
    EXPECT_EQ(stream.state().phase, StreamPhase::failed);
    clock_.set(clock_.now() + wait - 1e-3);
    EXPECT_EQ(stream.state().retries, count - 1);
    clock_.set(clock_.now() + 2e-3);
    ASSERT_TRUE(retried(count)) << wait;
  }
  EXPECT_EQ(stream.state().problem, "table (fake): unplugged");
  give(stream, clock_.now() + 1);
  EXPECT_EQ(stream.state().phase, StreamPhase::running);
  ASSERT_TRUE(fail(++count));
  ASSERT_TRUE(retried(count)) << "a good frame begins anew";
}

TEST_F(StreamTest, TakesAThrowingCameraForAFailingOne) {
  const Stream stream = this->stream();
  script_->give({.reason = "bus error", .throws = true});
  ASSERT_TRUE(eventually([&] { return stream.state().failures == 1; }));
  EXPECT_EQ(stream.state().problem, "table (fake): bus error");
  give(stream, 1);
  expect_touchable(stream, 1);
}

TEST_F(StreamTest, EndsWhenTheLastFrameIsPrepared) {
  touchable_.close();
  const Stream stream = this->stream();
  give(stream, 1);
  script_->give({.status = CameraStatus::ended});
  ASSERT_TRUE(eventually([&] { return script_->pending() == 0; }));
  EXPECT_NE(stream.state().phase, StreamPhase::ended);
  touchable_.open();
  EXPECT_TRUE(eventually([&] { return stream.state().phase == StreamPhase::ended; }));
  EXPECT_EQ(touchable_.stamps(), std::vector{1.0});
  clock_.set(100);
  EXPECT_EQ(stream.state().phase, StreamPhase::ended) << "the end is no stall";
}

TEST_F(StreamTest, TellsOfTheEndAfterTheLastFrame) {
  std::atomic<std::size_t> pushed_at_end{99};
  const Stream stream(std::make_unique<FakeCamera>(script_), "table", touchable_.sink(), clock_, {},
                      [&] { pushed_at_end = touchable_.stamps().size(); });
  give(stream, 0.1);
  script_->give({.status = CameraStatus::ended});
  ASSERT_TRUE(eventually([&] { return stream.state().phase == StreamPhase::ended; }));
  EXPECT_EQ(pushed_at_end, 1u);
}

TEST_F(StreamTest, StopsInEveryState) {
  { const Stream starting = this->stream(); }
  {
    const Stream failing = this->stream({.first_retry = 1e6, .longest_retry = 1e6});
    script_->give({.status = CameraStatus::failed, .reason = "a"});
    script_->give({.status = CameraStatus::failed, .reason = "b"});
    ASSERT_TRUE(eventually([&] { return failing.state().failures == 2; }));
  }
  {
    const Stream ended = this->stream();
    script_->give({.status = CameraStatus::ended});
    ASSERT_TRUE(eventually([&] { return ended.state().phase == StreamPhase::ended; }));
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
  EXPECT_THROW(Stream(nullptr, "table", touchable_.sink(), clock_), Error);
}

TEST_F(StreamTest, ManyLookOnWhileItRuns) {
  const Stream stream = this->stream({.stall = kNever}, false);
  std::vector<std::thread> observers;
  for (int i = 0; i < 3; ++i) {
    observers.emplace_back([&] {
      while (stream.state().phase != StreamPhase::ended) std::this_thread::yield();
    });
  }
  for (int i = 1; i <= 200; ++i) script_->give({.frame = frame_at(i, static_cast<float>(i))});
  script_->give({.status = CameraStatus::ended});
  for (std::thread& observer : observers) observer.join();
  EXPECT_EQ(stream.state().touchable, 200u);
}

}  // namespace
}  // namespace palpate
