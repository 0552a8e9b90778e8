// Four cameras at 30 Hz, out of step, beside a servo at 1 kHz, in simulated time: how old is what
// is felt, and what is lost?
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/stream.hpp"
#include "sim/simulated_camera.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using test::kTick;

constexpr int kCameras = 4;
constexpr double kInterval = 1. / 30;  // s
constexpr double kLatency = 0.01;      // s

// Frames of a camera that were made touchable: stamps, and from when on they are felt.
struct Lane {
  std::unique_ptr<SimulatedCamera> camera;
  Source* source = nullptr;
  std::vector<double> stamps, starts;

  void take(const DepthFrame& frame, const Source::StartTime& start) {
    double from = 0;
    source->push(frame, [&] { return from = start(); });
    stamps.push_back(frame.stamp);
    starts.push_back(from);
  }

  // The age of what is felt at time t, s; negative: nothing yet.
  [[nodiscard]] double age(double t) const {
    const auto next = std::ranges::upper_bound(starts, t);
    return next == starts.begin() ? -1
                                  : t - stamps[std::ranges::distance(starts.begin(), next) - 1];
  }
};

class FourCameras : public testing::Test {
 protected:
  void open(const std::string& more) {
    for (int k = 0; k < kCameras; ++k) {
      Lane& lane = lanes_.emplace_back();
      const std::string name = "camera " + std::to_string(k + 1);
      lane.camera = open_simulated("still,width=160,loop=8,seed=" + std::to_string(k + 1) +
                                       ",view=" + std::to_string(8 * k - 12) +
                                       ",phase=" + std::to_string(k * kInterval / kCameras) + more,
                                   nullptr);
      lane.source = &scene_.add(name);
      streams_.emplace_back(
          *lane.camera, name,
          [&lane](const DepthFrame& frame, const Source::StartTime& start) {
            lane.take(frame, start);
          },
          SimulatedStreamOptions{.latency = kLatency});
    }
  }

  // Presses 3 mm into the table's free patch. Calls `look` once every camera is felt.
  template <class Look>
  void play(double seconds, const Look& look) {
    SceneField field(scene_);
    Proxy proxy;
    for (int tick = 0; tick * kTick < seconds; ++tick) {
      const double now = tick * kTick;
      for (SimulatedStream& stream : streams_) stream.advance(now);
      const Eigen::Vector3d hip(-0.04, 0, std::max(-3e-3, 0.05 - 0.5 * now));
      field.update(now, hip, proxy);
      const Contact contact = proxy.step(field, hip, kTick);
      if (now > 0.3) look(now, contact);
    }
  }

  Scene scene_;
  std::deque<Lane> lanes_;
  std::vector<SimulatedStream> streams_;
};

TEST_F(FourCameras, WhatIsFeltIsNeverOlderThanLatencyAndAFramesTimeAndNothingIsLost) {
  open("");
  int ticks = 0;
  play(1.5, [&](double now, const Contact& contact) {
    ++ticks;
    EXPECT_TRUE(contact.touching) << now;
    for (const Lane& lane : lanes_) {
      const double age = lane.age(now);
      EXPECT_GE(age, kLatency - 1e-9) << lane.source->name() << " at " << now;
      EXPECT_LE(age, kLatency + kInterval + kTick + 1e-9) << lane.source->name() << " at " << now;
    }
  });
  EXPECT_GT(ticks, 1000);
  for (const SimulatedStream& stream : streams_) {
    const StreamState state = stream.state();
    EXPECT_EQ(state.drops.total(), 0u) << state.problem;
    EXPECT_EQ(state.touchable, state.frames);
    EXPECT_GE(state.frames, 44u);
  }
}

TEST_F(FourCameras, FramesThatComeIrregularlyOrNeverCostContactNothing) {
  open(",jitter=0.01,dropped=0.2");
  play(1.5, [&](double now, const Contact& contact) { EXPECT_TRUE(contact.touching) << now; });
  for (const SimulatedStream& stream : streams_) {
    EXPECT_EQ(stream.state().drops.total(), 0u) << stream.state().problem;
    EXPECT_LT(stream.state().frames, 44u);
  }
}

}  // namespace
}  // namespace palpate
