#include "palpate/servo/realtime.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <thread>

namespace palpate {
namespace {

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
  EXPECT_NE(report.requests[0].remedy.find("taskset"), std::string::npos);
  EXPECT_NE(report.requests[1].remedy.find("1 to 99"), std::string::npos);
  const std::string words = in_words(report);
  EXPECT_EQ(std::ranges::count(words, '\n'), 2) << words;
  EXPECT_NE(words.find("not granted"), std::string::npos);
}

TEST(Realtime, PinsToAProcessorThatThereIs) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  int processor = 0;
  while (!CPU_ISSET(static_cast<std::size_t>(processor), &allowed)) ++processor;
  const RealtimeReport report =
      asked({.realtime_priority = false, .lock_memory = false, .processor = processor});
  EXPECT_TRUE(report.all_granted()) << in_words(report);
}

}  // namespace
}  // namespace palpate
