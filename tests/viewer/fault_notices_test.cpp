#include <gtest/gtest.h>

#include "viewer/reports.hpp"

namespace palpate::viewer {
namespace {

ViewerOptions::Stream stream(StreamState::Phase phase, const std::string& problem = "",
                             double problem_at = 0) {
  ViewerOptions::Stream stream;
  stream.state.source = "table";
  stream.state.phase = phase;
  stream.state.problem = problem;
  stream.state.problem_at = problem_at;
  return stream;
}

using Notices = std::vector<Notice>;
const Notice kDark{Viewer::NoticeLevel::warning, "table (simulated): dark"};

TEST(FaultNotices, AStreamsProblemIsToldOnceInItsOwnWordsAndAgainWhenItComesBack) {
  FaultNotices faults;
  const auto look = [&](double problem_at) {
    return faults.update(std::vector{stream(StreamState::Phase::running, kDark.text, problem_at)},
                         {});
  };
  EXPECT_TRUE(faults.update(std::vector{stream(StreamState::Phase::running)}, {}).empty());
  EXPECT_EQ(look(5), Notices{kDark});
  EXPECT_TRUE(look(5).empty());
  for (double time = 6; time < 60; time += 1) EXPECT_TRUE(look(time).empty()) << "it goes on";
  EXPECT_EQ(look(80), Notices{kDark});
  EXPECT_TRUE(faults.present().empty()) << "it runs";
}

TEST(FaultNotices, WhatLastsIsPresentUntilItEnds) {
  FaultNotices faults;
  const std::vector stalled{stream(StreamState::Phase::stalled, kDark.text, 5)};
  EXPECT_EQ(faults.update(stalled, {}), Notices{kDark});
  EXPECT_TRUE(faults.update(stalled, {}).empty());
  EXPECT_EQ(faults.present(), Notices{kDark});
  const std::vector runs{stream(StreamState::Phase::running, kDark.text, 5)};
  Notice taken_back = kDark;
  taken_back.over = true;
  EXPECT_EQ(faults.update(runs, {}), Notices{taken_back});
  EXPECT_TRUE(faults.update(runs, {}).empty());
  EXPECT_TRUE(faults.present().empty());
}

TEST(FaultNotices, ADeviceOfASourcesNameAndOneOfAnotherDevicesAreKeptApart) {
  FaultNotices faults;
  const std::vector<DeviceFault> devices{{"table", Guard::Fault::none},
                                         {"table", Guard::Fault::device}};
  const std::vector stalled{stream(StreamState::Phase::stalled, kDark.text, 5)};
  EXPECT_EQ(faults.update(stalled, devices).size(), 2u);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(faults.update(stalled, devices).empty());
  EXPECT_EQ(faults.present().size(), 2u);
  EXPECT_EQ(faults.present().back().level, Viewer::NoticeLevel::fault);
  EXPECT_TRUE(faults.present().back().text.starts_with("table: "));
}

TEST(FaultNotices, AFaultThatIsForgottenAndLatchedAgainIsTold) {
  FaultNotices faults;
  const std::vector<DeviceFault> well{{"one", Guard::Fault::none}};
  const std::vector<DeviceFault> failed{{"one", Guard::Fault::device}};
  EXPECT_EQ(faults.update({}, failed).size(), 1u);
  const Notices over = faults.update({}, well);
  ASSERT_EQ(over.size(), 1u);
  EXPECT_TRUE(over.front().over);
  EXPECT_TRUE(faults.present().empty());
  EXPECT_EQ(faults.update({}, failed).size(), 1u);
}

}  // namespace
}  // namespace palpate::viewer
