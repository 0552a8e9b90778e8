// Cameras that stall, freeze, fail, and send what is of no use.
#include <gtest/gtest.h>

#include <future>

#include "sensor/stream_fixture.hpp"
#include "sensor/stream_statistics.hpp"

namespace palpate {
namespace {

using namespace sensor;

TEST_F(StreamTest, NoticesSilence) {
  const Stream stream = this->stream({.stall = 0.5});
  give(stream, 0.1);
  pass(stream, 0.4);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  pass(stream, 0.2);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
  pass(stream, 5);
  EXPECT_EQ(stream.state().stalls, 1u) << "one silence, one stall";
  EXPECT_EQ(stream.state().problem, "table (fake): no frame for 0.6 s");
  EXPECT_DOUBLE_EQ(stream.state().problem_at, 0.7);
  give(stream, 7);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
}

TEST_F(StreamTest, NoticesACameraThatNeverDelivers) {
  const Stream stream = this->stream({.stall = 0.5});
  pass(stream, 0.6);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
}

TEST_F(StreamTest, NoticesAFrozenPicture) {
  const Stream stream = this->stream({.stall = 0.5});
  for (int i = 0; i <= 8; ++i) give(stream, 0.125 * i, frame_at(0.125 * i, 2));
  expect_touchable(stream, 1);
  const StreamState state = stream.state();
  EXPECT_EQ(state.phase, StreamState::Phase::stalled);
  EXPECT_EQ(state.stalls, 1u);
  EXPECT_EQ(state.drops.repeated, 8u);
  EXPECT_NE(state.problem.find("identical"), std::string::npos) << state.problem;
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
  const StreamState::Drops drops = stream.state().drops;
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
    script_->give({.status = DepthCamera::Status::failed, .reason = "unplugged"});
    return eventually([&] { return stream.state().failures == failures; });
  };
  const auto retried = [&](std::uint64_t retries) {
    return eventually([&] { return stream.state().retries == retries; });
  };
  ASSERT_TRUE(fail(1));
  ASSERT_TRUE(retried(1)) << "at once: one frame may be broken";
  EXPECT_EQ(stream.state().phase, StreamState::Phase::starting);
  std::uint64_t count = 1;
  for (const double wait : {1.0, 2.0, 3.0, 3.0}) {
    ASSERT_TRUE(fail(++count));
    EXPECT_EQ(stream.state().phase, StreamState::Phase::failed);
    clock_.set(clock_.now() + wait - 1e-3);
    EXPECT_EQ(stream.state().retries, count - 1);
    clock_.set(clock_.now() + 2e-3);
    ASSERT_TRUE(retried(count)) << wait;
  }
  EXPECT_EQ(stream.state().problem, "table (fake): unplugged");
  give(stream, clock_.now() + 1);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  ASSERT_TRUE(fail(++count));
  ASSERT_TRUE(retried(count)) << "a good frame begins anew";
}

TEST_F(StreamTest, AsksADeviceThatSendsDamagedFramesAgainAtOnce) {
  const Stream stream = this->stream({.stall = 0.5, .first_retry = 1e9, .longest_retry = 1e9});
  give(stream, 0.1);
  for (std::uint64_t i = 1; i <= 20; ++i) {
    clock_.set(0.1 + 0.01 * static_cast<double>(i));
    script_->give({.status = DepthCamera::Status::damaged, .reason = "cut off"});
    ASSERT_TRUE(eventually([&] { return stream.state().drops.garbage == i; })) << i;
  }
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  EXPECT_EQ(stream.state().problem, "table (fake): cut off");
  EXPECT_EQ(stream.state().failures, 0u) << "the device is there";
  clock_.set(0.7);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
  EXPECT_EQ(stream.state().problem, "table (fake): no usable frame for 0.6 s; the last: cut off");
  give(stream, 0.8);
  expect_touchable(stream, 2);
  EXPECT_EQ(stream.state().frames, 22u);
}

// One that is damaged between two failures tells that the device is back.
TEST_F(StreamTest, BeginsAnewWithItsWaitsAfterADamagedFrame) {
  const Stream stream = this->stream({.stall = kNever, .first_retry = 1e9, .longest_retry = 1e9});
  for (std::uint64_t i = 1; i <= 3; ++i) {
    script_->give({.status = DepthCamera::Status::failed, .reason = "unplugged"});
    ASSERT_TRUE(eventually([&] { return stream.state().failures == i; }));
    script_->give({.status = DepthCamera::Status::damaged, .reason = "cut off"});
    ASSERT_TRUE(eventually([&] { return stream.state().drops.garbage == i; }));
  }
  EXPECT_EQ(stream.state().phase, StreamState::Phase::starting);
}

TEST_F(StreamTest, TakesAThrowingCameraForAFailingOne) {
  const Stream stream = this->stream();
  script_->give({.reason = "bus error", .throws = true});
  ASSERT_TRUE(eventually([&] { return stream.state().failures == 1; }));
  EXPECT_EQ(stream.state().problem, "table (fake): bus error");
  give(stream, 1);
  expect_touchable(stream, 1);
}

TEST_F(StreamTest, TakesACameraThatWaitsAfterItFailedForAStalledOne) {
  const Stream stream = this->stream({.stall = 0.5, .first_retry = 1e-3, .longest_retry = 1e-3});
  give(stream, 0.1);
  for (std::uint64_t i = 1; i <= 2; ++i) {
    script_->give({.status = DepthCamera::Status::failed, .reason = "unplugged"});
    ASSERT_TRUE(eventually([&] { return stream.state().failures == i; }));
  }
  EXPECT_EQ(stream.state().phase, StreamState::Phase::failed);
  pass(stream, 0.2);
  EXPECT_EQ(stream.state().problem, "table (fake): unplugged") << "it is asked again, and waits";
  pass(stream, 0.3);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
  EXPECT_EQ(stream.state().problem, "table (fake): no frame for 0.5 s");
}

TEST(StreamStatistics, SayWhatASilentCameraWaitsFor) {
  sensor::StreamStatistics log("table", "fake", 0.5, 0);
  log.waiting(0.4, "nobody is there");
  EXPECT_EQ(log.state(0.4).problem, "");
  log.waiting(0.6, "nobody is there");
  EXPECT_EQ(log.state(0.6).problem, "table (fake): no frame for 0.6 s: nobody is there");
  log.frame_received(0.7, {}, 0);
  EXPECT_EQ(log.state(1.4).problem, "table (fake): no frame for 0.7 s") << "somebody was";
}

// A driver that does not come back from read().
class HangingCamera final : public DepthCamera {
 public:
  explicit HangingCamera(std::shared_future<void> let_go) : let_go_(std::move(let_go)) {}
  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double /*timeout*/) override {
    if (read_++ > 0) let_go_.wait();
    frame = frame_at(0.1);
    return read_ == 1 ? DepthCamera::Status::frame : DepthCamera::Status::ended;
  }
  [[nodiscard]] std::string reason() const override { return {}; }

 private:
  std::shared_future<void> let_go_;
  CameraInfo info_{.name = "hanging"};
  int read_ = 0;
};

TEST_F(StreamTest, TellsOfADriverThatHangs) {
  std::promise<void> let_go;
  clock_.set(0.1);
  HangingCamera camera(let_go.get_future().share());
  const Stream stream(camera, "table", touchable_.sink(), clock_, {.stall = 0.5});
  expect_touchable(stream, 1);
  clock_.set(0.5);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  clock_.set(0.7);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
  EXPECT_EQ(stream.state().stalls, 1u);
  EXPECT_EQ(stream.state().problem, "table (hanging): no frame for 0.6 s");
  let_go.set_value();
  EXPECT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::ended; }));
}

TEST_F(StreamTest, TellsOfACameraOnAnotherClock) {
  {
    const Stream behind = this->stream();
    give(behind, 1000, frame_at(1));
    expect_touchable(behind, 1);
    EXPECT_NE(behind.state().problem.find("another clock"), std::string::npos)
        << behind.state().problem;
    give(behind, 1001, frame_at(2, 2));
    expect_touchable(behind, 2);
  }
  const Stream ahead = this->stream();
  give(ahead, 1001, frame_at(9000));
  give(ahead, 1002, frame_at(9001));
  EXPECT_EQ(ahead.state().drops.late, 2u);
  EXPECT_NE(ahead.state().problem.find("another clock"), std::string::npos)
      << ahead.state().problem;
}

}  // namespace
}  // namespace palpate
