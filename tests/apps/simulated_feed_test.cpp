#include "apps/palpate/simulated_feed.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

// Answers as it was told, one after the other, and then that it has ended.
class ToldCamera final : public DepthCamera {
 public:
  struct Answer {
    CameraStatus status = CameraStatus::frame;
    double stamp = 0;
  };

  ToldCamera(std::string name, std::deque<Answer> answers) : answers_(std::move(answers)) {
    info_.name = std::move(name);
    info_.paces = false;
  }

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  [[nodiscard]] CameraStatus read(DepthFrame& frame, double) override {
    ++reads_;
    if (answers_.empty()) return CameraStatus::ended;
    const Answer answer = answers_.front();
    if (answers_.size() > 1 || answer.status == CameraStatus::frame) answers_.pop_front();
    frame.stamp = answer.stamp;
    frame.camera.width = 4;
    frame.camera.height = 3;
    return answer.status;
  }
  [[nodiscard]] std::string reason() const override { return "the cable is loose"; }
  [[nodiscard]] int reads() const { return reads_; }

 private:
  CameraInfo info_;
  std::deque<Answer> answers_;
  int reads_ = 0;
};

DepthFrame frame_at(double stamp) {
  DepthFrame frame;
  frame.stamp = stamp;
  return frame;
}

std::deque<ToldCamera::Answer> frames(std::initializer_list<double> stamps) {
  std::deque<ToldCamera::Answer> answers;
  for (const double stamp : stamps) answers.push_back({CameraStatus::frame, stamp});
  return answers;
}

// What sinks were given: who, the stamp, and from when it is to be felt.
struct Pushed {
  std::string source;
  double stamp;
  double start;
};

struct Record {
  std::vector<Pushed> pushed;
  int ended = 0;

  SimulatedFeed::Feeding feeding(DepthCamera& camera, const std::string& name, double first) {
    return {&camera, frame_at(first), name,
            [this, name](const DepthFrame& frame, const StartTime& start) {
              pushed.push_back({name, frame.stamp, start()});
            },
            [this] { ++ended; }};
  }
};

TEST(SimulatedFeed, FramesAreFeltAtTheirStampPlusLatencyFromTheFirstOneOn) {
  ToldCamera camera("one", frames({100.1, 100.2}));
  Record record;
  SimulatedFeed feed({record.feeding(camera, "a", 100)}, 0.01);
  feed.advance(0.0099);
  EXPECT_TRUE(record.pushed.empty());
  feed.advance(0.0101);
  ASSERT_EQ(record.pushed.size(), 1u);
  EXPECT_EQ(record.pushed[0].stamp, 0);
  EXPECT_EQ(record.pushed[0].start, 0.01);
  feed.advance(5);
  ASSERT_EQ(record.pushed.size(), 3u);
  EXPECT_NEAR(record.pushed[2].stamp, 0.2, 1e-9);
  EXPECT_NEAR(record.pushed[2].start, 0.21, 1e-9);
  EXPECT_EQ(record.ended, 1);
  EXPECT_EQ(feed.reports()[0].state.phase, StreamPhase::ended);
  EXPECT_NEAR(feed.reports()[0].state.rate, 10, 1e-6);
}

TEST(SimulatedFeed, SeveralCamerasAreServedInTheOrderOfTheirStamps) {
  ToldCamera one("one", frames({10.4, 10.6}));
  ToldCamera two("two", frames({10.3, 10.6}));
  Record record;
  SimulatedFeed feed({record.feeding(one, "a", 10.2), record.feeding(two, "b", 10)}, 0);
  feed.advance(9);
  std::string order;
  for (const Pushed& each : record.pushed) order += each.source;
  EXPECT_EQ(order, "babaab") << "of one time, the camera that was given first";
  EXPECT_NEAR(record.pushed[1].start, 0.2, 1e-9) << "t = 0 is the earliest of all first frames";
}

TEST(SimulatedFeed, FramesThatGoBackInTimeAreDroppedAndCounted) {
  ToldCamera camera("one", frames({0.1, 0.1, 0.05, 0.2}));
  Record record;
  SimulatedFeed feed({record.feeding(camera, "a", 0)}, 0);
  feed.advance(1);
  EXPECT_EQ(record.pushed.size(), 3u);
  const FeedReport report = feed.reports()[0];
  EXPECT_EQ(report.state.drops.late, 2u);
  EXPECT_EQ(report.state.frames, 5u);
  EXPECT_EQ(report.state.touchable, 3u);
}

TEST(SimulatedFeed, BadFramesAreCountedAndTheNextOneIsAsGoodAsEver) {
  ToldCamera camera("one", {{CameraStatus::failed, 0},
                            {CameraStatus::waiting, 0},
                            {CameraStatus::frame, 0.1},
                            {CameraStatus::frame, 0.2}});
  Record record;
  SimulatedFeed feed({record.feeding(camera, "a", 0)}, 0);
  feed.advance(1);
  EXPECT_EQ(record.pushed.size(), 3u);
  const StreamState state = feed.reports()[0].state;
  EXPECT_EQ(state.failures, 1u);
  EXPECT_EQ(state.stalls, 1u);
  EXPECT_EQ(state.camera, "one");
  EXPECT_EQ(state.source, "a");
  EXPECT_FALSE(state.problem.empty());
}

TEST(SimulatedFeed, CameraThatOnlyFailsIsGivenUpAndDoesNotEnd) {
  ToldCamera broken("broken", {{CameraStatus::failed, 0}});
  ToldCamera whole("whole", frames({0.1, 0.2, 0.3}));
  Record record;
  SimulatedFeed feed({record.feeding(broken, "a", 0), record.feeding(whole, "b", 0)}, 0);
  feed.advance(1);
  EXPECT_EQ(record.pushed.size(), 5u) << "the others go on";
  EXPECT_LT(broken.reads(), 1000);
  const StreamState state = feed.reports()[0].state;
  EXPECT_EQ(state.phase, StreamPhase::failed);
  EXPECT_NE(state.problem.find("cable"), std::string::npos);
  EXPECT_EQ(record.ended, 1) << "that of the whole one: a broken one's surface fades";
}

TEST(SimulatedFeed, WhatPreparationRefusesIsCountedByItsReason) {
  ToldCamera camera("one", frames({0.1}));
  SimulatedFeed feed(
      {{&camera, frame_at(0), "a",
        [](const DepthFrame&, const StartTime&) { throw Error("of another size"); }}},
      0);
  feed.advance(1);
  const StreamState state = feed.reports()[0].state;
  EXPECT_EQ(state.drops.refused, 2u);
  EXPECT_EQ(state.touchable, 0u);
  EXPECT_NE(state.problem.find("another size"), std::string::npos);
}

}  // namespace
}  // namespace palpate::app
