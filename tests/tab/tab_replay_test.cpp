// Recordings in a tab: those of the program, and files that are none.
#include "tab/tab_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "apps/palpate/record/recorder.hpp"
#include "apps/setup_parsed.hpp"
#include "bag/mcap_writer.hpp"
#include "message/palpate_types.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "support/folder.hpp"
#include "tab/heard_page.hpp"

namespace palpate::tab {
namespace {

using testing::HasSubstr;

constexpr double kBegin = 7;  // s, on the run's clock
constexpr int kSteps = 3000;

FileBytes in_memory(const std::string& text) {
  const std::shared_ptr<std::byte[]> bytes(new std::byte[text.size()]);
  std::ranges::copy(std::as_bytes(std::span(text)), bytes.get());
  return {bytes, text.size()};
}

struct ReplayPage : HeardPage {
  explicit ReplayPage(const std::string& file, const std::string& name = "run.mcap")
      : HeardPage([&](Outside outside, const Clock& clock) {
          return open_run(name, in_memory(file), std::move(outside), clock);
        }) {}

  void play(bool on, double speed = 1) { say({{"type", "play"}, {"on", on}, {"speed", speed}}); }
  void seek(double time) {
    say({{"type", "seek"}, {"time", time}});
    run(8e-3);
  }
  // s from the first step on.
  [[nodiscard]] double shown() const { return test::number_at<double>(state(), 8) - kBegin; }
  // The forces of all steps that states told of.
  [[nodiscard]] std::vector<Eigen::Vector3f> felt() const {
    std::vector<Eigen::Vector3f> forces;
    for (const std::string& each : states) {
      for (std::size_t i = 0; i < test::u16(each, 2); ++i) {
        const std::size_t at = 92 + 12 * i;
        forces.emplace_back(test::f32(each, at), test::f32(each, at + 4), test::f32(each, at + 8));
      }
    }
    return forces;
  }
};

// A hand that dips into a floor is recorded.
class TabReplayTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const test::Folder folder;
    std::string floor;
    for (int i = 0; i < 900; ++i)
      floor += fmt::format("{} {} 0\n", 1e-3 * (i % 30), 1e-3 * (i / 30));
    folder.write("floor.xyz", floor);
    app::LoadedScene loaded =
        app::load_sources(app::planned(folder / "floor.xyz").sources, {.keep_clouds = true});
    app::begin_run(loaded, {});
    ScriptedDevice device({{0, Eigen::Vector3d::Zero()}, {1, Eigen::Vector3d::Zero()}});
    app::Recorder recorder(folder / "run.mcap");
    ServoOptions options;
    options.traces = recorder.add_hand();
    Servo servo(device, loaded.scene, options);
    recorder.begin(loaded, {&servo}, 0, true);
    for (int i = 0; i < kSteps; ++i) {
      DeviceState hand;
      hand.position = {15e-3, 15e-3, 1e-3 - 3e-3 * std::sin(3e-3 * i)};
      servo.step(hand, kBegin + 1e-3 * i);
      servo.show();
      forces.push_back(servo.state().force.cast<float>());
      recorder.keep_up();
    }
    (void)recorder.finish();
    file = folder.read("run.mcap");
  }

  inline static std::string file;
  inline static std::vector<Eigen::Vector3f> forces;  // of each step
};

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

std::string words(const std::string& bytes, const std::string& name) {
  try {
    const ReplayPage page(bytes, name);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST_F(TabReplayTest, WhatIsNoRecordingIsRefusedInWords) {
  const test::Folder folder;
  {
    bag::McapWriter writer(folder / "other.mcap");
    const auto topic = writer.add_topic<message::Image>("/camera/depth/image_raw");
    writer.write(topic, {1, 1}, message::Image{});
    writer.close();
  }
  EXPECT_THAT(words(folder.read("other.mcap"), "other.mcap"), HasSubstr("no recording of a run"));
  EXPECT_THAT(words(folder.read("other.mcap"), "other"), HasSubstr("palpate touch --record"));
  EXPECT_THAT(words("", "empty.mcap"), HasSubstr("empty.mcap"));
  EXPECT_THAT(words("1 2 3\n", "cloud.mcap"), HasSubstr("cloud.mcap"));
  EXPECT_THAT(words(file.substr(0, 300), "head.mcap"), HasSubstr("head.mcap"));
}

// It is refused, or plays; what it says of itself is not believed.
TEST_F(TabReplayTest, DamagedBytesAreRefusedOrPlayed) {
  std::mt19937 random(1);
  int played = 0;
  for (int i = 0; i < 60; ++i) {
    std::string damaged = file;
    for (int n = 0; n < 1 + i % 8; ++n) {
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    }
    try {
      ReplayPage page(damaged);
      page.play(true, 4);
      page.run(0.3);
      page.seek(1.5);
      ++played;
    } catch (const std::exception& error) {
      EXPECT_THAT(error.what(), HasSubstr("run.mcap"));
    }
  }
  EXPECT_GT(played, 0);
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
