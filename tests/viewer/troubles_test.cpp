#include "viewer/troubles.hpp"

#include <gtest/gtest.h>

namespace palpate::viewer {
namespace {

ViewerStream stream(StreamPhase phase, const std::string& problem = "", double problem_at = 0) {
  ViewerStream stream;
  stream.state.source = "table";
  stream.state.phase = phase;
  stream.state.problem = problem;
  stream.state.problem_at = problem_at;
  return stream;
}

using Notices = std::vector<Notice>;
const Notice kDark{NoticeLevel::warning, "table (simulated): dark"};

TEST(Troubles, AStreamsProblemIsToldOnceInItsOwnWordsAndAgainWhenItComesBack) {
  Troubles troubles;
  const auto look = [&](double problem_at) {
    return troubles.look(std::vector{stream(StreamPhase::running, kDark.text, problem_at)}, {});
  };
  EXPECT_TRUE(troubles.look(std::vector{stream(StreamPhase::running)}, {}).empty());
  EXPECT_EQ(look(5), Notices{kDark});
  EXPECT_TRUE(look(5).empty());
  for (double time = 6; time < 60; time += 1) EXPECT_TRUE(look(time).empty()) << "it goes on";
  EXPECT_EQ(look(80), Notices{kDark});
  EXPECT_TRUE(troubles.present().empty()) << "it runs";
}

TEST(Troubles, WhatLastsIsPresentUntilItEnds) {
  Troubles troubles;
  const std::vector stalled{stream(StreamPhase::stalled, kDark.text, 5)};
  EXPECT_EQ(troubles.look(stalled, {}), Notices{kDark});
  EXPECT_TRUE(troubles.look(stalled, {}).empty());
  EXPECT_EQ(troubles.present(), Notices{kDark});
  const std::vector runs{stream(StreamPhase::running, kDark.text, 5)};
  EXPECT_TRUE(troubles.look(runs, {}).empty());
  EXPECT_TRUE(troubles.present().empty());
}

TEST(Troubles, ADeviceOfASourcesNameAndOneOfAnotherDevicesAreKeptApart) {
  Troubles troubles;
  const std::vector<DeviceFault> devices{{"table", GuardFault::none},
                                         {"table", GuardFault::device}};
  const std::vector stalled{stream(StreamPhase::stalled, kDark.text, 5)};
  EXPECT_EQ(troubles.look(stalled, devices).size(), 2u);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(troubles.look(stalled, devices).empty());
  EXPECT_EQ(troubles.present().size(), 2u);
  EXPECT_EQ(troubles.present().back().level, NoticeLevel::fault);
  EXPECT_TRUE(troubles.present().back().text.starts_with("table: "));
}

TEST(Troubles, AFaultThatIsForgottenAndLatchedAgainIsTold) {
  Troubles troubles;
  const std::vector<DeviceFault> well{{"one", GuardFault::none}};
  const std::vector<DeviceFault> failed{{"one", GuardFault::device}};
  EXPECT_EQ(troubles.look({}, failed).size(), 1u);
  EXPECT_TRUE(troubles.look({}, well).empty());
  EXPECT_TRUE(troubles.present().empty());
  EXPECT_EQ(troubles.look({}, failed).size(), 1u);
}

}  // namespace
}  // namespace palpate::viewer
