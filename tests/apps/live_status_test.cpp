#include "apps/palpate/touch/live_status.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/contains.hpp"

namespace palpate::app {
namespace {

using test::contains;

// A second of 1 kHz: 20 us of computing, the last hundredth 80; late by 50 us.
LiveMoment second() {
  Durations computing;
  Durations lateness;
  for (int i = 0; i < 1000; ++i) {
    computing.add(i < 985 ? 20e-6 : 80e-6);
    lateness.add(50e-6);
  }
  LiveMoment moment;
  moment.time = 12.34;
  HandMoment& hand = moment.hands.emplace_back();
  hand.name = "hand 1";
  hand.force = 1.234;
  hand.rate = 1000;
  hand.durations.computing = computing;
  hand.durations.lateness = lateness;
  StreamState stream;
  stream.source = "table";
  stream.phase = StreamState::Phase::running;
  stream.rate = 29.97;
  stream.latency_mean = 11.4e-3;
  moment.streams = {stream};
  return moment;
}

TEST(LiveStatus, TellsPaceForceAndStreamsInOneLine) {
  const std::string words = in_words(second());
  for (const char* part :
       {"12.3 s", "1.23 N", "1000 Hz", "late p99 0.05 ms", "table 30.0 Hz, 11 ms"}) {
    EXPECT_TRUE(contains(words, part)) << part << " in " << words;
  }
  EXPECT_FALSE(contains(words, "\n"));
  EXPECT_FALSE(contains(words, "dropped"));
  EXPECT_FALSE(contains(words, "FAULT"));
  EXPECT_FALSE(contains(words, "hand 1"));
  EXPECT_FALSE(contains(words, "torque"));
}

TEST(LiveStatus, TellsTheTorqueOfAToolThatTurns) {
  LiveMoment moment = second();
  moment.hands[0].servo.wrench.torque = {0.03, 0, 0.04};
  EXPECT_TRUE(contains(in_words(moment), "torque 0.050 N m"));
}

TEST(LiveStatus, TellsWhatIsWrong) {
  LiveMoment moment = second();
  moment.hands[0].servo.guard.fault = Guard::Fault::hand;
  moment.streams[0].phase = StreamState::Phase::stalled;
  moment.streams[0].drops.overtaken = 2;
  moment.streams[0].drops.late = 1;
  StreamState other;
  other.source = "side";
  moment.streams.push_back(other);
  std::string words = in_words(moment);
  for (const char* part :
       {"FAULT: the device reported", "table STALLED", "3 dropped", "side waiting"}) {
    EXPECT_TRUE(contains(words, part)) << part << " in " << words;
  }
  moment.streams[0].phase = StreamState::Phase::failed;
  moment.streams[1].phase = StreamState::Phase::ended;
  words = in_words(moment);
  EXPECT_TRUE(contains(words, "table FAILED"));
  EXPECT_TRUE(contains(words, "side ended"));
}

TEST(LiveStatus, TellsHowOldWhatIsFeltIs) {
  LiveMoment moment = second();
  moment.streams[0].phase = StreamState::Phase::running;
  moment.streams[0].age = 0.16;
  EXPECT_FALSE(contains(in_words(moment), "OLD")) << "two frames of 30 Hz after 0.1 s";
  moment.streams[0].age = 4.9;
  EXPECT_TRUE(contains(in_words(moment), "what is felt is 4.90 s OLD")) << in_words(moment);
  moment.streams[0].phase = StreamState::Phase::ended;
  EXPECT_FALSE(contains(in_words(moment), "OLD")) << "a recording's last surface stays";
}

TEST(LiveStatus, TellsOfEachHandByName) {
  LiveMoment moment = second();
  moment.hands.push_back(moment.hands[0]);
  moment.hands[1].name = "hand 2";
  moment.hands[1].silence = "no client is sending to 'a'";
  moment.hands.push_back(moment.hands[0]);
  moment.hands[2].name = "hand 3";
  moment.hands[2].ended = true;
  moment.hands[2].servo.guard.fault = Guard::Fault::device;
  const std::string words = in_words(moment);
  for (const char* part :
       {"12.3 s | hand 1: 1.23 N  1000 Hz", "| hand 2: no client is sending to 'a' |",
        "| hand 3: ended  FAULT: ", "| table 30.0 Hz"}) {
    EXPECT_TRUE(contains(words, part)) << part << " in " << words;
  }
}

TEST(LiveStatus, TellsWhatARobotIsToldAndWhyNot) {
  LiveMoment moment = second();
  RosBridge::RobotState& robot = moment.robot.emplace();
  robot.topic = "/target_pose";
  robot.told = 250;
  EXPECT_TRUE(in_words(moment).ends_with(" | robot: no subscriber to /target_pose"));
  robot.readers = 1;
  EXPECT_TRUE(in_words(moment).ends_with(" | robot: 250 targets"));
  robot.age = 0.043;
  EXPECT_TRUE(in_words(moment).ends_with(" | robot: 250 targets, seen 43 ms ago"));
  robot.why = "no source has a surface";
  EXPECT_TRUE(in_words(moment).ends_with(" | robot WAITS: no source has a surface"));
  robot.retreats = true;
  robot.why = "the surface passed over the tool 0.4 s ago";
  EXPECT_TRUE(
      in_words(moment).ends_with(" | robot GOES BACK: the surface passed over the tool 0.4 s ago"));
}

TEST(LiveStatus, KnowsOfNothingBeforeTheFirstStep) {
  LiveMoment moment;
  moment.hands.resize(1);
  EXPECT_TRUE(contains(in_words(moment), "0.0 s  0.00 N  0 Hz"));
}

TEST(LiveStatus, FitsIntoATerminalsLine) {
  EXPECT_EQ(fitted("abc", 10), "abc");
  EXPECT_EQ(fitted("abcdef", 3), "abc");
  EXPECT_EQ(fitted("", 3), "");
  EXPECT_EQ(fitted("a\xc2\xb5"
                   "bc",
                   2),
            "a\xc2\xb5")
      << "no character is cut";
}

}  // namespace
}  // namespace palpate::app
