#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/palpate/record/recorder.hpp"
#include "apps/setup_parsed.hpp"
#include "palpate/device/simulated.hpp"
#include "support/folder.hpp"
#include "tab/heard_page.hpp"

namespace palpate::tab {

inline constexpr double kBegin = 7;  // s, on the run's clock
inline constexpr int kSteps = 3000;

inline FileBytes in_memory(const std::string& text) {
  const std::shared_ptr<std::byte[]> bytes(new std::byte[text.size()]);
  std::ranges::copy(std::as_bytes(std::span(text)), bytes.get());
  return {bytes, text.size()};
}

/// The page of a recording.
struct ReplayPage : HeardPage {
  explicit ReplayPage(const std::string& file, const std::string& name = "run.mcap",
                      double alone = 0)
      : HeardPage(
            [&](Outside outside, const Clock& clock) {
              return open_run(name, in_memory(file), std::move(outside), clock, "news");
            },
            alone) {}

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

/// A hand that dips into a floor is recorded.
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

}  // namespace palpate::tab
