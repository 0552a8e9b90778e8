// Recordings of the program in a tab.
#include "tab/tab_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "apps/program.hpp"
#include "tab/recorded_run.hpp"

namespace palpate::tab {
namespace {

using testing::HasSubstr;

TEST_F(TabReplayTest, WelcomesAPageToARecordingAndShowsItsCloudAndItsForces) {
  ReplayPage page(file);
  page.run(1);
  const json welcome = page.last("welcome");
  EXPECT_EQ(welcome["scene"], "run.mcap");
  EXPECT_NEAR(welcome["timeline"]["length"], 1e-3 * (kSteps - 1), 1e-9);
  EXPECT_GT(welcome["opens"], 1e8);
  EXPECT_FALSE(welcome["devices"][0].value("takeable", false));
  EXPECT_EQ(page.clouds, 1);
  const auto larger = [](const auto& a, const auto& b) { return a.norm() < b.norm(); };
  const float largest = std::ranges::max_element(forces, larger)->norm();
  ASSERT_GT(largest, 0.1F);
  const std::vector<float> envelope = page.last("envelope")["forces"];
  EXPECT_NEAR(*std::ranges::max_element(envelope), largest, 1e-3) << "rounded for the page";
  page.say({{"type", "set"}, {"key", "scene"}, {"value", "room"}});
  EXPECT_EQ(page.opened, "synthetic:room");
  page.say({{"type", "reset"}});
  EXPECT_THAT(std::string(page.last("refused")["text"]), HasSubstr("reset"));
}

TEST_F(TabReplayTest, PlaysAllForcesThatWereRecordedAndStopsAtTheEnd) {
  ReplayPage page(file);
  page.seek(0);
  page.run(0.1);
  page.states.clear();
  page.play(true);
  page.run(3.2);
  EXPECT_EQ(page.felt(), (std::vector(forces.begin() + 1, forces.end()))) << "0 is shown before";
  EXPECT_EQ(page.last("time")["playing"], false);
  EXPECT_NEAR(page.last("time")["time"], 1e-3 * (kSteps - 1), 1e-6);
  page.play(true, 4);
  page.run(0.5);
  EXPECT_NEAR(page.shown(), 2, 0.1) << "again, from the beginning";
}

TEST_F(TabReplayTest, ASeekShowsItsStepAndWhatWasFeltBefore) {
  ReplayPage page(file);
  for (const double time : {1.5, 0.3, 2.9, 1.2345}) {
    page.seek(time);
    page.run(0.05);
    const auto step = static_cast<std::size_t>(std::lround(1e3 * page.shown()));
    EXPECT_NEAR(page.shown(), time, 1e-3 + 1e-9);
    EXPECT_EQ(page.force().cast<float>(), forces[step]);
    ASSERT_EQ(test::u32(page.past, 4), step + 1) << "from the first step on";
    EXPECT_EQ(test::f32(page.past, 16 + 16 * step + 12), forces[step].z());
  }
}

// It would take the place of what the page heard since.
TEST_F(TabReplayTest, WhileForcesAreReadThePastIsNotToldAgain) {
  ReplayPage page(file);
  page.play(true);
  page.run(1);
  EXPECT_EQ(page.pasts, 1) << "that of the welcome";
  EXPECT_GT(page.last("envelope")["forces"][200], 0) << "all of it is read";
  page.seek(0.5);
  page.run(0.5);
  EXPECT_EQ(page.pasts, 2);
}

TEST_F(TabReplayTest, TheSameCallsGiveTheSameStates) {
  const auto states = [] {
    ReplayPage page(file);
    page.seek(0.5);
    page.play(true, 2);
    page.run(0.7);
    return page.states;
  };
  const std::vector<std::string> once = states();
  EXPECT_GT(once.size(), 30U);
  EXPECT_EQ(once, states());
}

TEST_F(TabReplayTest, ACutRecordingShowsWhatIsThereAndSaysSo) {
  ReplayPage page(file.substr(0, 3 * file.size() / 5), "cut.mcap");
  page.run(0.1);
  EXPECT_THAT(std::string(page.last("notice")["text"]), HasSubstr("cut.mcap"));
  const double length = page.last("welcome")["timeline"]["length"];
  EXPECT_GT(length, 0.5);
  EXPECT_LT(length, 2.9);
  page.seek(0.5);
  page.run(0.05);
  EXPECT_EQ(page.force().cast<float>(), forces[500]);
}

TEST(TabReplay, ACameraShowsTheFrameThatWasFelt) {
  app::Shell shell;
  ASSERT_EQ(shell
                .run("touch camera:simulated --simulated-time --duration 1 --no-view --record "
                     "run.mcap")
                .code,
            0);
  ReplayPage page(shell.read("run.mcap"));
  page.run(0.1);
  EXPECT_TRUE(page.last("welcome")["sources"][0]["camera"]);
  const int first = page.clouds;
  EXPECT_GT(first, 0) << "it begins where there is a surface";
  page.play(true);
  page.run(0.6);
  EXPECT_GT(page.clouds, first + 2) << "another one with each frame";
}

}  // namespace
}  // namespace palpate::tab
