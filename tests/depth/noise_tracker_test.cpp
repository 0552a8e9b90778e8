#include "depth/noise_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "depth/noisy_frames.hpp"
#include "palpate/base/error.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate {
namespace {

using depth::DepthView;
using depth::NoiseTracker;
using test::kBlurred;
using test::kDepths;
using test::kTruth;
using test::view_of;

/// Largest and smallest of what the model says over what is true.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
};

Range sigma_ratio(const NoiseModel& model, const NoiseModel& truth = kTruth) {
  Range range;
  for (const double z : kDepths) {
    const double ratio = model.sigma(z) / truth.sigma(z);
    range.low = std::min(range.low, ratio);
    range.high = std::max(range.high, ratio);
  }
  return range;
}

void expect_sigma(const NoiseModel& model, double tolerance) {
  const Range ratio = sigma_ratio(model);
  EXPECT_GT(ratio.low, 1 - tolerance);
  EXPECT_LT(ratio.high, 1 + tolerance);
}

NoiseModel from_one_frame(const DepthView& frame,
                          const NoiseModel& prior = unknown_sensor_noise()) {
  return NoiseTracker(prior).update(frame);
}

NoiseModel from_one_frame(const std::vector<Solid>& solids, const SimulatedNoiseOptions& options) {
  const std::vector<float> image = test::noisy_image(test::exact_image(solids), options);
  return from_one_frame(view_of(image));
}

// A grille before a wall: no window is flat, and single frames show 0.1 m.
TEST(NoiseTracker, WhatFillsTheImageIsNotTakenForNoise) {
  std::vector<float> exact(640 * 480);
  for (std::size_t i = 0; i < exact.size(); ++i) exact[i] = i % 8 < 4 ? 0.7F : 1.0F;
  NoiseTracker tracker(unknown_sensor_noise());
  for (std::uint64_t k = 0; k < 12; ++k) {
    const std::vector<float> image = test::noisy_image(exact, {.seed = 5}, k);
    tracker.update(view_of(image));
  }
  EXPECT_LT(tracker.model().sigma(0.7), 5 * kTruth.sigma(0.7));
}

TEST(NoiseTracker, FindsIndependentNoiseInOneFrame) {
  for (const int balls : {0, 6, 60}) {
    SCOPED_TRACE(balls);
    const NoiseModel model = from_one_frame(test::clutter(balls), {.seed = 3});
    expect_sigma(model, 0.1);
    EXPECT_GE(model.correlation, 1);
    EXPECT_LT(model.correlation, 1.5);
  }
}

// Two pixels of blur: n_c = 4 pi 2^2 = 50 pixels, c = sqrt(50) = 7.1.
TEST(NoiseTracker, FindsCorrelatedNoiseInOneFrame) {
  for (const int balls : {0, 6}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      SCOPED_TRACE(balls);
      const NoiseModel model =
          from_one_frame(test::clutter(balls), {.kind = NoiseKind::blurred, .seed = seed});
      expect_sigma(model, 0.1);
      EXPECT_NEAR(model.correlation, kBlurred, 0.2 * kBlurred);
    }
  }
}

TEST(NoiseTracker, ErrsHighByLittleWhereClutterLooksLikeCorrelation) {
  const NoiseModel model = from_one_frame(test::clutter(60), {.kind = NoiseKind::blurred});
  EXPECT_GT(model.correlation, 0.85 * kBlurred);
  EXPECT_LT(model.correlation, 1.5 * kBlurred);
}

// Four pixels of blur: c = sqrt(201) = 14.2, of which windows of 40 pixels see a part.
TEST(NoiseTracker, FindsQuantisedNoiseInOneFrame) {
  const NoiseModel model =
      from_one_frame(test::clutter(6), {.kind = NoiseKind::quantised, .silhouettes = true});
  const Range ratio = sigma_ratio(model);
  EXPECT_GT(ratio.low, 0.85);
  EXPECT_LT(ratio.high, 1.35);
  EXPECT_GT(model.correlation, 10.5);
  EXPECT_LT(model.correlation, 16);
}

TEST(NoiseTracker, SilhouettesDoNotDisturb) {
  const NoiseModel model = from_one_frame(test::clutter(20), {.silhouettes = true});
  expect_sigma(model, 0.1);
  EXPECT_LT(model.correlation, 1.5);
}

TEST(NoiseTracker, StepsOfASensorAreNotTakenForSilence) {
  // No noise, but steps of 4 mm: rounding alone errs by step / sqrt(12).
  const SimulatedNoiseOptions options{.kind = NoiseKind::none, .rounding = 4e-3};
  const NoiseModel model = from_one_frame(test::table_and_wall(), options);
  for (const double z : kDepths) {
    EXPECT_GT(model.sigma(z), 0.8 * 4e-3 / std::sqrt(12.0));
    EXPECT_LT(model.sigma(z), 4e-3);
  }
}

TEST(NoiseTracker, ExactDepthsKeepASmallNoise) {
  const std::vector<float> image = test::exact_image(test::table_and_wall());
  const NoiseModel model = from_one_frame(view_of(image));
  for (const double z : kDepths) {
    EXPECT_GT(model.sigma(z), 0.5e-4 * z);
    EXPECT_LT(model.sigma(z), 5e-4 * z);
  }
}

TEST(NoiseTracker, FallsBackWhereAFrameTellsNothing) {
  const NoiseModel prior = unknown_sensor_noise();
  const auto expect_prior = [&](const std::vector<float>& image) {
    const NoiseModel model = from_one_frame(view_of(image), prior);
    EXPECT_EQ(model.coefficients, prior.coefficients);
    EXPECT_EQ(model.correlation, prior.correlation);
  };
  const std::size_t pixels = 640 * 480;
  expect_prior(std::vector<float>(pixels, 0.0F));                                     // covered
  expect_prior(std::vector<float>(pixels, 0.8F));                                     // constant
  expect_prior(std::vector<float>(pixels, 65.535F));                                  // too far
  expect_prior(std::vector<float>(pixels, std::numeric_limits<float>::quiet_NaN()));  // no numbers
  std::vector<float> few(pixels, 0.0F);
  for (std::size_t i = 0; i < pixels; i += 1000) few[i] = 0.7F + 1e-6F * static_cast<float>(i);
  expect_prior(few);
}

TEST(NoiseTracker, TakesSmallImages) {
  const CameraModel camera{64, 48, {52.5, 52.5, 31.5, 23.5}, {}};
  const std::vector<float> image = test::noisy_image(
      test::exact_image(test::table_and_wall(), camera), {.rounding = 0}, 0, camera);
  const NoiseModel model = from_one_frame(view_of(image, camera));
  EXPECT_GT(sigma_ratio(model).low, 0.5);
  EXPECT_LT(sigma_ratio(model).high, 2);
  for (const int side : {0, 1, 9}) {
    const std::vector<float> tiny(static_cast<std::size_t>(side) * side, 1.0F);
    const DepthView view{tiny, side, side, 50, 0.1F, 20};
    EXPECT_EQ(from_one_frame(view, kTruth).coefficients, kTruth.coefficients);
  }
}

TEST(NoiseTracker, StartsWithTheFirstFrameAndStaysThere) {
  for (const NoiseKind kind : {NoiseKind::independent, NoiseKind::blurred}) {
    SimulatedNoise noise({.kind = kind});
    const std::vector<float> exact = test::exact_image(test::clutter(6));
    NoiseTracker tracker(unknown_sensor_noise());
    const double c = kind == NoiseKind::independent ? 1 : kBlurred;
    for (std::uint64_t frame = 0; frame < 40; ++frame) {
      std::vector<float> image = exact;
      noise.apply(640, 480, frame, image);
      const NoiseModel& model = tracker.update(view_of(image));
      if (frame % 13 > 0) continue;
      expect_sigma(model, 0.12);
      EXPECT_GT(model.correlation, 0.8 * c);
      EXPECT_LT(model.correlation, c == 1 ? 1.5 : 1.2 * c);
    }
  }
}

// A plane that comes nearer by a third of sigma a frame looks like noise that a whole tile shares.
TEST(NoiseTracker, MotionIsNotTakenForNoise) {
  for (const double speed : {0.01, 0.03, 0.3}) {  // m/s
    SCOPED_TRACE(speed);
    NoiseTracker tracker(unknown_sensor_noise());
    SimulatedNoise noise({});
    NoiseModel model;
    for (int frame = 0; frame < 20; ++frame) {
      std::vector<float> image = test::exact_image(test::table_and_wall());
      for (float& z : image) z -= static_cast<float>(speed * frame / 30);
      noise.apply(640, 480, static_cast<std::uint64_t>(frame), image);
      model = tracker.update(view_of(image));
    }
    expect_sigma(model, 0.15);
    EXPECT_LT(model.correlation, 1.5);
  }
}

TEST(NoiseTracker, RepeatedFramesChangeNothing) {
  const std::vector<float> image = test::noisy_image(test::exact_image(test::clutter(6)), {});
  NoiseTracker tracker(unknown_sensor_noise());
  const NoiseModel first = tracker.update(view_of(image));
  for (int i = 0; i < 300; ++i) tracker.update(view_of(image));
  EXPECT_EQ(tracker.model().coefficients, first.coefficients);
  EXPECT_EQ(tracker.model().correlation, first.correlation);
}

TEST(NoiseTracker, FollowsASensorThatChanges) {
  const std::vector<float> exact = test::exact_image(test::table_and_wall());
  SimulatedNoiseOptions loud{.model = kTruth};
  for (double& c : loud.model.coefficients) c *= 2;
  SimulatedNoise quiet_noise({});
  SimulatedNoise loud_noise(loud);
  NoiseTracker tracker(unknown_sensor_noise());
  for (std::uint64_t frame = 0; frame < 300; ++frame) {
    std::vector<float> image = exact;
    (frame < 3 ? quiet_noise : loud_noise).apply(640, 480, frame, image);
    tracker.update(view_of(image));
  }
  EXPECT_GT(sigma_ratio(tracker.model(), loud.model).low, 0.85);
  EXPECT_LT(sigma_ratio(tracker.model(), loud.model).high, 1.15);
}

TEST(NoiseTracker, WaitsForAFrameThatTellsSomething) {
  NoiseTracker tracker(unknown_sensor_noise());
  std::vector<float> covered(640 * 480, 0.0F);
  for (int i = 0; i < 5; ++i) {
    covered[0] = static_cast<float>(i);
    EXPECT_EQ(tracker.update(view_of(covered)).correlation, unknown_sensor_noise().correlation);
  }
  SimulatedNoise noise({});
  for (std::uint64_t frame = 0; frame < 40; ++frame) {
    std::vector<float> image = test::exact_image(test::table_and_wall());
    noise.apply(640, 480, frame, image);
    tracker.update(view_of(image));
  }
  expect_sigma(tracker.model(), 0.12);
}

TEST(NoiseTracker, TakesFramesOfAnotherSize) {
  NoiseTracker tracker(unknown_sensor_noise());
  const CameraModel small{320, 240, {262.5, 262.5, 159.5, 119.5}, {}};
  const std::vector<Solid> solids = test::table_and_wall();
  const std::vector<float> large_image = test::noisy_image(test::exact_image(solids), {});
  const std::vector<float> small_image =
      test::noisy_image(test::exact_image(solids, small), {}, 0, small);
  tracker.update(view_of(large_image));
  expect_sigma(tracker.update(view_of(small_image, small)), 0.15);
  tracker.reset();
  EXPECT_EQ(tracker.model().coefficients, unknown_sensor_noise().coefficients);
  expect_sigma(tracker.update(view_of(large_image)), 0.12);
}

TEST(SensorNoise, IsFoundByName) {
  for (const char* sensor : {"kinect1", "xtion", "realsense", "tof"}) {
    const NoiseModel noise = sensor_noise(sensor);
    for (const double z : {0.1, 1.0, 10.0}) EXPECT_GT(noise.sigma(z), 0);
    EXPECT_GE(noise.correlation, 1);
  }
  EXPECT_NEAR(sensor_noise("xtion").sigma(0.7), 0.63e-3, 0.01e-3);
  EXPECT_NEAR(sensor_noise("realsense").sigma(1), 2.5e-3, 0.05e-3);
  try {
    (void)sensor_noise("kinect7");
    FAIL();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("kinect7"), std::string::npos);
    EXPECT_NE(text.find("realsense"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate
