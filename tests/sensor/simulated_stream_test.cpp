#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"
#include "sensor/fake_camera.hpp"

namespace palpate {
namespace {

using namespace sensor;

// What the sink was given: the frame's stamp, from when it is to be felt, and the time it was then.
struct Taken {
  double stamp;
  double start;
  double at;
};

class SimulatedStreamTest : public testing::Test {
 protected:
  [[nodiscard]] SimulatedStream stream(const SimulatedStreamOptions& options = kAtOnce) {
    return {camera_, "table",
            [this](const DepthFrame& frame, const Source::StartTime& start) {
              taken_.push_back({frame.stamp, start(), now_});
            },
            options, [this] { ended_at_.push_back(now_); }};
  }

  // Frames whose pictures differ.
  void give(std::initializer_list<double> stamps) {
    for (const double stamp : stamps) give(frame_at(stamp, ++depth_));
  }
  void give(DepthFrame frame) { script_->give({.frame = std::move(frame)}); }
  void give(DepthCamera::Status status, const std::string& reason = "") {
    script_->give({.status = status, .reason = reason});
  }

  // In milliseconds, as a servo does it.
  void play(SimulatedStream& stream, double until) {
    for (; now_ <= until; now_ = 1e-3 * ++ticks_) stream.advance(now_);
  }

  static constexpr SimulatedStreamOptions kAtOnce = {.latency = 0, .patience = 0};

  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  FakeCamera camera_{script_, false};
  std::vector<Taken> taken_;
  std::vector<double> ended_at_;
  double now_ = 0;
  int ticks_ = 0;
  float depth_ = 0;
};

TEST_F(SimulatedStreamTest, FramesAreFeltAtTheirStampPlusLatency) {
  give({0, 0.1, 0.2});
  give(DepthCamera::Status::ended);
  SimulatedStream stream = this->stream({.latency = 0.01, .patience = 0});
  EXPECT_EQ(camera_.begun(), 0) << "all cameras of a run begin at its t = 0";
  stream.advance(0.0099);
  EXPECT_TRUE(taken_.empty());
  EXPECT_EQ(stream.state().phase, StreamState::Phase::starting);
  stream.advance(0.0101);
  ASSERT_EQ(taken_.size(), 1u);
  EXPECT_EQ(taken_[0].start, 0.01);
  stream.advance(5);
  ASSERT_EQ(taken_.size(), 3u);
  EXPECT_DOUBLE_EQ(taken_[2].stamp, 0.2);
  EXPECT_DOUBLE_EQ(taken_[2].start, 0.21);
  const StreamState state = stream.state();
  EXPECT_EQ(state.source, "table");
  EXPECT_EQ(state.camera, "fake");
  EXPECT_EQ(state.frames, 3u);
  EXPECT_EQ(state.touchable, 3u);
  EXPECT_NEAR(state.latency_mean, 0.01, 1e-12);
  EXPECT_EQ(state.latency_worst, 0.01);
  EXPECT_TRUE(state.problem.empty()) << state.problem;
}

TEST_F(SimulatedStreamTest, AreReadyByTheLeadBefore) {
  give({0, 0.1});
  SimulatedStream stream = this->stream({.latency = 0.01, .lead = 0.004, .patience = 0});
  play(stream, 0.2);
  ASSERT_EQ(taken_.size(), 2u);
  EXPECT_NEAR(taken_[1].at, 0.106, 1e-9);
  EXPECT_DOUBLE_EQ(taken_[1].start, 0.11);
}

TEST_F(SimulatedStreamTest, TellsOfTheEndAfterTheLastFrame) {
  give({0, 0.1});
  give(DepthCamera::Status::ended);
  SimulatedStream stream = this->stream();
  play(stream, 0.05);
  EXPECT_TRUE(ended_at_.empty());
  play(stream, 9);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::ended);
  EXPECT_EQ(stream.state().stalls, 0u) << "the end is no stall";
  EXPECT_NEAR(stream.state().rate, 10, 1e-9) << "nor does its rate fall";
  ASSERT_EQ(ended_at_.size(), 1u);
  EXPECT_EQ(ended_at_[0], taken_.back().at);
}

// The same frames to one in real time and one in simulated time: they say the same.
TEST_F(SimulatedStreamTest, ObjectsToWhatAStreamObjectsTo) {
  const auto answer = [&](Script& script) {
    DepthFrame cut = frame_at(0.3, 3);
    cut.depth.resize(5);
    script.give({.frame = frame_at(0, 1)});
    script.give({.frame = frame_at(0.1, 1)});
    script.give({.frame = frame_at(0.2, 0)});
    script.give({.frame = cut});
    script.give({.frame = frame_at(0.4, 4, 8, 6)});
    script.give({.frame = frame_at(0, 5)});
    script.give({.frame = frame_at(std::nan(""), 6)});
    script.give({.status = DepthCamera::Status::unposed, .reason = "nowhere"});
    script.give({.status = DepthCamera::Status::damaged, .reason = "torn"});
    script.give({.frame = frame_at(0.9, 9)});
    script.give({.status = DepthCamera::Status::ended});
  };
  answer(*script_);
  SimulatedStream stream = this->stream({.latency = 0, .stall = 1e9, .patience = 0});
  play(stream, 2);
  const auto script = std::make_shared<Script>();
  answer(*script);
  FakeCamera camera(script, false);
  const SteadyClock clock;
  const Stream live(camera, "table",
                    [](const DepthFrame&, const Source::StartTime& start) { (void)start(); }, clock,
                    {.stall = 1e9});
  ASSERT_TRUE(eventually([&] { return live.state().phase == StreamState::Phase::ended; }));
  const StreamState state = stream.state();
  EXPECT_EQ(state.phase, StreamState::Phase::ended);
  EXPECT_EQ(state.frames, live.state().frames);
  EXPECT_EQ(state.touchable, live.state().touchable);
  for (const auto cause :
       {&StreamState::Drops::overtaken, &StreamState::Drops::repeated, &StreamState::Drops::late,
        &StreamState::Drops::empty, &StreamState::Drops::garbage, &StreamState::Drops::unposed,
        &StreamState::Drops::resized, &StreamState::Drops::refused}) {
    EXPECT_EQ(state.drops.*cause, live.state().drops.*cause);
  }
  EXPECT_EQ(state.drops.late, 2u);
  EXPECT_EQ(state.drops.garbage, 2u);
  EXPECT_EQ(state.drops.unposed, 1u);
  EXPECT_EQ(state.drops.total(), 8u);
  EXPECT_EQ(state.problem, live.state().problem);
  EXPECT_EQ(state.problem, "table (fake): torn");
}

TEST_F(SimulatedStreamTest, NoticesAFrozenPictureAndThatItMovesAgain) {
  for (int i = 0; i <= 9; ++i) give(frame_at(0.1 * i, 2));
  SimulatedStream stream = this->stream();
  play(stream, 0.95);
  EXPECT_EQ(taken_.size(), 1u);
  StreamState state = stream.state();
  EXPECT_EQ(state.phase, StreamState::Phase::stalled);
  EXPECT_EQ(state.drops.repeated, 9u);
  EXPECT_NE(state.problem.find("identical"), std::string::npos) << state.problem;
  give({1});
  play(stream, 1.1);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::running);
  EXPECT_EQ(stream.state().stalls, 1u);
  FakeCamera still(script_, false, true);
  for (int i = 0; i <= 9; ++i) give(frame_at(0.1 * i, 2));
  SimulatedStream allowed(
      still, "table", [](const DepthFrame&, const Source::StartTime&) {}, kAtOnce);
  allowed.advance(2);
  EXPECT_EQ(allowed.state().drops.total(), 0u);
}

TEST_F(SimulatedStreamTest, TakesAnotherSizeThatLasts) {
  give({0});
  for (int i = 1; i <= 4; ++i) give(frame_at(0.1 * i, ++depth_, 8, 6));
  SimulatedStream stream = this->stream();
  play(stream, 1);
  EXPECT_EQ(stream.state().drops.resized, 2u);
  EXPECT_EQ(stream.state().size_changes, 1u);
  EXPECT_EQ(stream.state().touchable, 3u);
}

// However many: a recording goes on behind them.
TEST_F(SimulatedStreamTest, DamagedFramesTakeTheirTimeAndTheNextIsAsGoodAsEver) {
  constexpr int kDamaged = 300;
  for (int i = 0; i < kDamaged; ++i) give(DepthCamera::Status::damaged, "it has no pose");
  give({kDamaged / 30.0});
  SimulatedStream stream = this->stream();
  play(stream, 5);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
  play(stream, 10.2);
  ASSERT_EQ(taken_.size(), 1u);
  EXPECT_NEAR(taken_[0].at, kDamaged / 30.0, 1.1e-3) << "in time";
  EXPECT_EQ(stream.state().drops.garbage, static_cast<std::uint64_t>(kDamaged));
  EXPECT_EQ(stream.state().problem, "table (fake): it has no pose");
}

TEST_F(SimulatedStreamTest, ACameraThatFailsIsNamedAndNeverGivenUp) {
  give({0});
  for (int i = 0; i < 150; ++i) give(DepthCamera::Status::failed, "the cable is loose");
  SimulatedStream stream = this->stream();
  play(stream, 2);
  StreamState state = stream.state();
  EXPECT_EQ(state.phase, StreamState::Phase::failed);
  EXPECT_EQ(state.problem, "table (fake): the cable is loose");
  EXPECT_NEAR(state.problem_at, 2, 1 / 30.0);
  EXPECT_NEAR(static_cast<double>(state.failures), 2 * 30, 2) << "once in a frame's time";
  EXPECT_EQ(state.retries + 1, state.failures);
  EXPECT_TRUE(ended_at_.empty()) << "its surface fades";
  play(stream, 6);
  give({6});
  play(stream, 6.2);
  state = stream.state();
  EXPECT_EQ(state.touchable, 2u);
  EXPECT_EQ(state.phase, StreamState::Phase::running);
  EXPECT_EQ(state.failures, 150u);
}

TEST_F(SimulatedStreamTest, ACameraThatIsSilentHasStalled) {
  give({0});
  SimulatedStream stream = this->stream();
  play(stream, 3);
  EXPECT_EQ(stream.state().phase, StreamState::Phase::stalled);
  EXPECT_EQ(stream.state().stalls, 1u);
  EXPECT_NE(stream.state().problem.find("table (fake): no frame for"), std::string::npos);
  EXPECT_LT(script_->reads(), 3 * 30 + 5);
}

TEST_F(SimulatedStreamTest, StampsThatStandStillDoNotHoldUpTime) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  give({0});
  for (int i = 0; i < 100; ++i) give({i % 2 == 0 ? 0 : kInfinite});
  SimulatedStream stream = this->stream();
  stream.advance(1);
  EXPECT_NEAR(static_cast<double>(stream.state().drops.late), 30, 2);
  EXPECT_GT(script_->pending(), 60u) << "the rest is yet to come";
  EXPECT_NE(stream.state().problem.find("frame"), std::string::npos);
}

TEST_F(SimulatedStreamTest, CountsWhatPreparationRefuses) {
  give({0, 0.1});
  SimulatedStream stream(
      camera_, "table",
      [](const DepthFrame&, const Source::StartTime&) { throw Error("all too much"); }, kAtOnce,
      [] { throw Error("no end"); });
  give(DepthCamera::Status::ended);
  stream.advance(1);
  EXPECT_EQ(stream.state().drops.refused, 3u);
  EXPECT_EQ(stream.state().touchable, 0u);
  EXPECT_EQ(stream.state().problem, "table (fake): a frame could not be prepared: no end");
  EXPECT_EQ(stream.state().phase, StreamState::Phase::ended);
}

TEST_F(SimulatedStreamTest, TakesAThrowingCameraForAFailingOne) {
  script_->give({.reason = "bus error", .throws = true});
  give({0.1});
  SimulatedStream stream = this->stream();
  stream.advance(0.05);
  EXPECT_EQ(stream.state().problem, "table (fake): bus error");
  stream.advance(1);
  EXPECT_EQ(stream.state().touchable, 1u);
}

TEST_F(SimulatedStreamTest, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)stream({.latency = -1}), Error);
  EXPECT_THROW((void)stream({.latency = 0.01, .lead = 0.02}), Error);
  EXPECT_THROW((void)stream({.stall = 0}), Error);
  EXPECT_THROW((void)stream({.patience = std::nan("")}), Error);
  FakeCamera paces(script_, true);
  const auto sink = [](const DepthFrame&, const Source::StartTime&) {};
  EXPECT_THROW(SimulatedStream(paces, "table", sink), Error);
}

}  // namespace
}  // namespace palpate
