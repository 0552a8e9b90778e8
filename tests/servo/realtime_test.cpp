#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <thread>

#include "palpate/servo/servo_thread.hpp"

namespace palpate {
namespace {

// That the calling thread may run on.
cpu_set_t allowed() {
  cpu_set_t set;
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  return set;
}

int first_of(const cpu_set_t& set) {
  int processor = 0;
  while (!CPU_ISSET(static_cast<std::size_t>(processor), &set)) ++processor;
  return processor;
}

RealtimeReport asked(const RealtimeOptions& options) {
  RealtimeReport report;
  std::jthread([&] { report = make_realtime(options); }).join();  // leaves this thread as it is
  return report;
}

TEST(Realtime, AsksForNothingWhenToldSo) {
  const RealtimeReport report = asked({.realtime_priority = false, .lock_memory = false});
  EXPECT_TRUE(report.requests.empty());
  EXPECT_TRUE(report.all_granted());
  EXPECT_EQ(in_words(report), "");
}

TEST(Realtime, SaysOfEachRequestWhetherItWasGrantedOrHowToPermitIt) {
  const RealtimeReport report = asked({.realtime_priority = true, .lock_memory = false});
  ASSERT_EQ(report.requests.size(), 1u);
  EXPECT_EQ(report.requests[0].granted, report.requests[0].remedy.empty());
  EXPECT_NE(in_words(report).find("SCHED_FIFO"), std::string::npos);
}

TEST(Realtime, SaysWhatIsWrongWithWhatCannotBe) {
  const RealtimeReport report = asked(
      {.realtime_priority = true, .priority = 1000, .lock_memory = false, .processor = 100'000});
  ASSERT_EQ(report.requests.size(), 2u);
  EXPECT_FALSE(report.all_granted());
  const std::string& pinned = report.requests[0].remedy;
  EXPECT_NE(pinned.find("AllowedCPUs="), std::string::npos) << pinned;
  EXPECT_NE(pinned.find(fmt::format("may run on {}", first_of(allowed()))), std::string::npos)
      << pinned;
  EXPECT_NE(report.requests[1].remedy.find("1 to 99"), std::string::npos);
  const std::string words = in_words(report);
  EXPECT_EQ(std::ranges::count(words, '\n'), 2) << words;
  EXPECT_NE(words.find("not granted"), std::string::npos);
}

TEST(Realtime, PinsToAProcessorThatThereIs) {
  const int processor = first_of(allowed());
  std::jthread([&] {
    const RealtimeReport report =
        make_realtime({.realtime_priority = false, .lock_memory = false, .processor = processor});
    EXPECT_TRUE(report.all_granted()) << in_words(report);
    const cpu_set_t pinned = allowed();
    EXPECT_EQ(CPU_COUNT(&pinned), 1);
    EXPECT_EQ(first_of(pinned), processor);
  }).join();
}

TEST(Realtime, WhatIsNotThereLeavesTheThreadWhereItMayRun) {
  const cpu_set_t before = allowed();
  std::jthread([&] {
    const RealtimeReport report =
        make_realtime({.realtime_priority = false, .lock_memory = false, .processor = -1});
    EXPECT_FALSE(report.all_granted());
    const cpu_set_t after = allowed();
    EXPECT_TRUE(CPU_EQUAL(&before, &after));
  }).join();
}

TEST(Realtime, LeavesAProcessorToTheServoWhichStillCanBePinnedToIt) {
  const cpu_set_t before = allowed();
  if (CPU_COUNT(&before) < 2) GTEST_SKIP() << "there is one processor alone";
  const int processor = first_of(before);
  std::jthread([&] {
    EXPECT_TRUE(leave_processor(processor).granted);
    const cpu_set_t left = allowed();
    EXPECT_FALSE(CPU_ISSET(static_cast<std::size_t>(processor), &left));
    EXPECT_EQ(CPU_COUNT(&left), CPU_COUNT(&before) - 1);
    EXPECT_FALSE(leave_processor(processor).granted);  // it is gone already
    EXPECT_TRUE(asked({.realtime_priority = false, .lock_memory = false, .processor = processor})
                    .all_granted());
  }).join();
}

TEST(Realtime, KeepsTheLastProcessor) {
  std::jthread([&] {
    const int processor = first_of(allowed());
    ASSERT_TRUE(
        make_realtime({.realtime_priority = false, .lock_memory = false, .processor = processor})
            .all_granted());
    const RealtimeReport::Request last = leave_processor(processor);
    EXPECT_FALSE(last.granted);
    EXPECT_NE(last.remedy.find("only one"), std::string::npos);
    EXPECT_FALSE(leave_processor(-1).granted);
  }).join();
}

}  // namespace
}  // namespace palpate
