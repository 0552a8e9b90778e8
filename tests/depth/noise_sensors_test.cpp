// What is told of the errors of many kinds of sensors, beside the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "depth/noise_tracker.hpp"
#include "depth/noisy_frames.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate {
namespace {

using depth::NoiseTracker;
using test::kBlurred;
using test::kDepths;
using test::kTruth;
using test::view_of;

/// A sensor's errors, and what is to be told of them.
struct Sensor {
  const char* name;
  void (*disturb)(std::uint64_t frame, std::vector<float>& depth);
  NoiseModel truth;
  double low, high;  // of what is told over sigma
};

void apply(const SimulatedNoiseOptions& options, std::uint64_t frame, std::vector<float>& depth) {
  SimulatedNoise(options).apply(640, 480, frame, depth);
}

// Every tenth pixel is anywhere.
void fly(std::uint64_t frame, std::vector<float>& depth) {
  Random random(100 + frame);
  for (float& z : depth) {
    if (random.uniform() < 0.1) z = static_cast<float>(0.3 + 1.2 * random.uniform());
  }
}

// Time of flight: half as sure on what is half as bright, half of the error shared by neighbours.
void disturb_by_light(std::uint64_t frame, std::vector<float>& depth) {
  SimulatedNoise alone({.seed = 1});
  SimulatedNoise together({.kind = NoiseKind::blurred, .seed = 2});
  const std::vector<float> a = alone.unit_noise(640, 480, frame);
  const std::vector<float> b = together.unit_noise(640, 480, frame);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double bright = (i % 640 / 90 + i / 640 / 70) % 2 == 0 ? 1 : 0.5;
    const double error = std::sqrt(0.5) * (a[i] + b[i]);
    depth[i] += static_cast<float>(0.004 / bright * depth[i] * depth[i] * error);
  }
}

const Sensor kSensors[] = {
    {"flying pixels",
     [](std::uint64_t frame, std::vector<float>& depth) {
       apply({.seed = 1}, frame, depth);
       fly(frame, depth);
     },
     {kTruth.coefficients, 1.15},
     0.9,
     1.2},
    {"flying pixels, blurred",
     [](std::uint64_t frame, std::vector<float>& depth) {
       apply({.kind = NoiseKind::blurred, .seed = 1}, frame, depth);
       fly(frame, depth);
     },
     {kTruth.coefficients, kBlurred},
     0.9,
     1.2},
    {"time of flight", disturb_by_light, {{0, 0, 0.0063}, 5}, 0.6, 1.3},
    {"stereo",
     [](std::uint64_t frame, std::vector<float>& depth) {
       apply({.kind = NoiseKind::blurred,
              .model = {{0, 0, 0.0025}, 1},
              .rounding = 0,
              .seed = 1,
              .disparity_step = 0.03125},
             frame, depth);
     },
     {{0, 0, 0.00256}, 6.8},
     0.85,
     1.15},
    {"structured light",
     [](std::uint64_t frame, std::vector<float>& depth) {
       apply({.kind = NoiseKind::blurred,
              .model = {{0, 0, 0.001}, 1},
              .seed = 1,
              .disparity_step = 0.125},
             frame, depth);
     },
     {{0.0002, 0, 0.00125}, 4.9},
     0.8,
     1.3},
    {"a fixed pattern",
     [](std::uint64_t frame, std::vector<float>& depth) {
       apply({.model = {{0.001, 0, 0}, 1}, .rounding = 0, .seed = 1, .pattern = 2e-3}, frame,
             depth);
     },
     {{std::sqrt(5.0) * 1e-3, 0, 0}, 1.15},
     0.9,
     1.15},
};

// What fits stumble over is noise and fixed errors alike, in the first frame as in later ones.
TEST(NoiseTracker, FindsTheErrorsOfAllKindsOfSensors) {
  const std::vector<float> exact = test::exact_image(test::clutter(6));
  for (const Sensor& sensor : kSensors) {
    NoiseTracker tracker(unknown_sensor_noise());
    for (std::uint64_t frame = 0; frame < 140; ++frame) {
      std::vector<float> image = exact;
      sensor.disturb(frame % 12, image);
      const NoiseModel& model = tracker.update(view_of(image));
      if (frame % 139 > 0) continue;
      SCOPED_TRACE(std::string(sensor.name) + ", frame " + std::to_string(frame));
      for (const double z : kDepths) {
        EXPECT_GT(model.sigma(z) / sensor.truth.sigma(z), sensor.low) << z;
        EXPECT_LT(model.sigma(z) / sensor.truth.sigma(z), sensor.high) << z;
      }
      EXPECT_NEAR(model.correlation, sensor.truth.correlation, 0.3 * sensor.truth.correlation);
    }
  }
}

// Balls in front of balls: windows that hold the correlation see their shape besides.
TEST(NoiseTracker, TellsNoiseFromClutterOverManyFrames) {
  const std::vector<float> exact = test::exact_image(test::clutter(60));
  NoiseTracker tracker(unknown_sensor_noise());
  for (std::uint64_t frame = 0; frame < 140; ++frame) {
    std::vector<float> image = exact;
    apply({.kind = NoiseKind::blurred, .seed = 1}, frame % 12, image);
    tracker.update(view_of(image));
  }
  for (const double z : kDepths) {
    EXPECT_NEAR(tracker.model().sigma(z), kTruth.sigma(z), 0.2 * kTruth.sigma(z));
  }
  EXPECT_NEAR(tracker.model().correlation, kBlurred, 0.2 * kBlurred);
}

}  // namespace
}  // namespace palpate
