#include "apps/palpate/run/touch_statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palpate::app {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::StartsWith;

ServoState step(double time, const Vector3d& hip, const Vector3d& force) {
  ServoState result;
  result.time = time;
  result.hip = hip;
  result.force = force;
  result.contact.touching = !force.isZero();
  return result;
}

TEST(TouchStatistics, EnergyOfAConstantForceIsForceTimesWay) {
  TouchStatistics statistics;
  for (int i = 0; i <= 10; ++i) statistics.add(step(i, {0.01 * i, 0, 0}, {2, 5, 0}));
  EXPECT_NEAR(statistics.given_energy(), 0.2, 1e-15);
  EXPECT_NEAR(statistics.path_energy(), 0.2, 1e-15);
}

TEST(TouchStatistics, KeepsTheLongestTorqueAndGrip) {
  TouchStatistics statistics;
  ServoState pressed = step(0, Vector3d::Zero(), {0, 0, 1});
  pressed.wrench.torque = {0.3, 0, -0.4};
  pressed.wrench.grip = -2;
  statistics.add(pressed);
  statistics.add(step(1, Vector3d::Zero(), {0, 0, 1}));
  EXPECT_DOUBLE_EQ(statistics.largest_torque(), 0.5);
  EXPECT_EQ(statistics.largest_grip(), 2);
}

TEST(TouchStatistics, SpringGivesBackWhatItTookAlongThePath) {
  TouchStatistics statistics;
  for (int i = 0; i <= 1000; ++i) {
    const double depth = 1e-3 * std::sin(std::numbers::pi * i / 1000);
    statistics.add(step(1e-3 * i, {0, 0, -depth}, {0, 0, 500 * depth}));
  }
  EXPECT_NEAR(statistics.path_energy(), 0, 1e-18);
}

TEST(TouchStatistics, HeldForceOfASpringGivesHalfStiffnessTimesEachStepSquared) {
  TouchStatistics statistics;
  double expected = 0;
  double before = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double depth = 1e-3 * std::sin(std::numbers::pi * i / 20);
    const double force = depth > 0 ? 500 * depth : 0;
    statistics.add(step(1e-3 * i, {0, 0, -depth}, {0, 0, force}));
    if (i > 0 && (depth > 1e-9 || before > 1e-9)) {
      expected += 0.5 * 500 * std::pow(depth - before, 2);
    }
    before = depth;
  }
  EXPECT_NEAR(statistics.given_energy(), expected, 1e-12);
  EXPECT_GT(expected, 1e-4);
  EXPECT_NEAR(statistics.path_energy(), 0, 1e-15);
}

TEST(TouchStatistics, EnergyIsOfTheHandsOwnWayWhereAClutchMovesTheTool) {
  TouchStatistics statistics;
  ServoState pressed = step(0, {0, 0, -4e-3}, {0, 0, 2});
  statistics.add(pressed);
  pressed.hip.setZero();  // the tool goes to the surface, the hand stays
  pressed.shift = {0, 0, 4e-3};
  statistics.add(pressed);
  EXPECT_EQ(statistics.given_energy(), 0);
  pressed.shift = {0, 0, 3e-3};  // the tool rests, the hand is pushed on
  statistics.add(pressed);
  EXPECT_NEAR(statistics.given_energy(), 2e-3, 1e-15);
}

TEST(TouchStatistics, PressingInTakesEnergyFromTheHand) {
  TouchStatistics statistics;
  for (int i = 0; i <= 100; ++i) {
    const double depth = 1e-5 * i;
    statistics.add(step(1e-3 * i, {0, 0, -depth}, {0, 0, 500 * depth}));
  }
  EXPECT_NEAR(statistics.path_energy(), -0.5 * 500 * 1e-6, 1e-15);
  EXPECT_NEAR(statistics.given_energy(), -0.5 * 500 * 1e-6 * 0.99, 1e-15);
}

TEST(TouchStatistics, CountsContactsAndKeepsTheLargest) {
  TouchStatistics statistics;
  for (const double force : {1., 0., 0., 2., 3., 0., 1.}) {
    statistics.add(step(static_cast<double>(statistics.steps()), Vector3d::Zero(), {force, 0, 0}));
  }
  EXPECT_EQ(statistics.contacts(), 3u);
  EXPECT_EQ(statistics.touching(), 4u);
  EXPECT_EQ(statistics.largest_force(), 3);
  EXPECT_EQ(statistics.largest_jump(), 3);
  EXPECT_EQ(statistics.duration(), 6);
}

TEST(TouchStatistics, TimesAreToldToFivePercentAndTheLongestExactly) {
  TouchStatistics statistics;
  for (int i = 1; i <= 1000; ++i) {
    ServoState each;
    each.timing.computing = 1e-6 * (1001 - i);
    statistics.add(each);
  }
  const StepTimes times = statistics.times();
  EXPECT_NEAR(times.p50, 500, 25);
  EXPECT_NEAR(times.p99, 990, 50);
  EXPECT_NEAR(times.p999, 999, 50);
  EXPECT_DOUBLE_EQ(times.maximum, 1000);
  EXPECT_EQ(statistics.steps(), 1000u);
  EXPECT_EQ(TouchStatistics().times().maximum, 0);
}

TEST(TouchStatistics, CountsEveryNoteUnderItsOwnName) {
  TouchStatistics statistics;
  ServoState each;
  each.contact.notes = ContactNote::lost | ContactNote::fault | ContactNote::fell;
  each.field_notes = FieldNote::thinned;
  statistics.add(each);
  std::string names;
  for (const CountedNote& note : statistics.notes(false)) {
    EXPECT_EQ(note.steps, 1u);
    names += std::string(note.name) + " ";
  }
  EXPECT_EQ(names, "lost fault fell thinned ");
  EXPECT_EQ(statistics.faults(), 1u);
}

TEST(TouchStatistics, CountsEveryBitOfContactsAndFields) {
  TouchStatistics statistics;
  ServoState each;
  for (unsigned bit = 1; bit <= static_cast<unsigned>(ContactNote::inside); bit <<= 1) {
    each.contact.notes |= static_cast<ContactNote>(bit);
  }
  for (unsigned bit = 1; bit <= static_cast<unsigned>(FieldNote::not_loaded); bit <<= 1) {
    each.field_notes = each.field_notes | static_cast<FieldNote>(bit);
  }
  statistics.add(each);
  EXPECT_EQ(statistics.notes(false).size(), 9u + 8u);
}

// A tool is not in one place, and its hand need not have gone far.
TEST(TouchStatistics, NotesOfAToolAreTrueOfATool) {
  TouchStatistics statistics;
  ServoState each;
  each.contact.notes = ContactNote::sweep_truncated | ContactNote::fell;
  each.field_notes = FieldNote::behind;
  statistics.add(each);
  const std::vector<CountedNote> point = statistics.notes(false);
  const std::vector<CountedNote> tool = statistics.notes(true);
  ASSERT_EQ(tool.size(), 3u);
  EXPECT_THAT(point[0].text, HasSubstr("the hand moved too far"));
  EXPECT_THAT(tool[0].text, HasSubstr("over an edge"));
  EXPECT_STREQ(tool[1].text, point[1].text);
  EXPECT_THAT(point[2].text, StartsWith("the tool was behind"));
  EXPECT_THAT(tool[2].text, StartsWith("a part of the tool was behind"));
}

}  // namespace
}  // namespace palpate::app
