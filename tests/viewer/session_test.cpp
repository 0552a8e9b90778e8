#include <gtest/gtest.h>

#include "viewer/client_sessions.hpp"

namespace palpate::viewer {
namespace {

using Kind = Topic::Kind;

Message message(const std::string& words) {
  return {std::make_shared<const std::string>(words), true};
}

std::string next(Outbox& outbox) {
  const auto taken = outbox.take();
  return taken ? *taken->bytes : "";
}

TEST(Outbox, ANewerMessageOfATopicReplacesTheOlderInItsPlace) {
  Outbox outbox;
  outbox.put({Kind::state, 0}, message("state 1"));
  outbox.put({Kind::cloud, 0}, message("cloud 1"));
  outbox.put({Kind::state, 1}, message("other"));
  for (int i = 2; i < 100; ++i) outbox.put({Kind::state, 0}, message("state " + std::to_string(i)));
  EXPECT_EQ(outbox.size(), 3u);
  EXPECT_EQ(next(outbox), "state 99");
  EXPECT_EQ(next(outbox), "cloud 1");
  EXPECT_EQ(next(outbox), "other");
  EXPECT_EQ(next(outbox), "");
  EXPECT_TRUE(outbox.empty());
}

TEST(Outbox, NoTopicStarvesWhileAnotherIsPutAgainAndAgain) {
  Outbox outbox;
  outbox.put({Kind::state, 0}, message("state"));
  outbox.put({Kind::cloud, 0}, message("cloud"));
  EXPECT_EQ(next(outbox), "state");
  outbox.put({Kind::state, 0}, message("state"));
  EXPECT_EQ(next(outbox), "cloud");
}

TEST(Outbox, AnswersGoFirstInTheirOrder) {
  Outbox outbox;
  outbox.put({Kind::state, 0}, message("state"));
  outbox.put({Kind::answer}, message("1"));
  outbox.put({Kind::answer}, message("2"));
  EXPECT_EQ(next(outbox), "1");
  EXPECT_EQ(next(outbox), "2");
  EXPECT_EQ(next(outbox), "state");
}

TEST(Outbox, WhoTakesNothingCostsABoundedNumberOfMessages) {
  Outbox outbox;
  for (int i = 0; i < 1000; ++i) outbox.put({Kind::answer}, message(std::to_string(i)));
  EXPECT_EQ(outbox.size(), Outbox::kMostAnswers);
  EXPECT_EQ(next(outbox), std::to_string(1000 - Outbox::kMostAnswers));
}

TEST(RateWindow, CountsEventsOfAStretchOfTime) {
  RateWindow window(3, 1.0);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(window.exceeded(5 + 0.1 * i));
  EXPECT_TRUE(window.exceeded(5.5));
  EXPECT_TRUE(window.exceeded(5.9));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(window.exceeded(6.0 + 0.1 * i));
  EXPECT_TRUE(window.exceeded(6.5));
}

}  // namespace
}  // namespace palpate::viewer
