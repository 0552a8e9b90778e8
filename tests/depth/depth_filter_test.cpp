#include "palpate/depth/depth_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.hpp"
#include "depth/small_frames.hpp"
#include "palpate/base/error.hpp"
#include "support/effort.hpp"
#include "support/thread_limit.hpp"

namespace palpate::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

DepthFilterOptions with_noise(int memory = 1) {
  DepthFilterOptions options;
  options.noise = kinect_like_noise();
  options.memory = memory;
  return options;
}

TEST(DepthFilter, RefusesOptionsThatMeanNothing) {
  const auto refused = [](auto change) {
    DepthFilterOptions options;
    change(options);
    EXPECT_THROW(DepthFilter{options}, Error);
  };
  refused([](DepthFilterOptions& o) { o.normal_error = 0; });
  refused([](DepthFilterOptions& o) { o.normal_error = std::nan(""); });
  refused([](DepthFilterOptions& o) { o.memory = 0; });
  refused([](DepthFilterOptions& o) { o.nearest = 0; });
  refused([](DepthFilterOptions& o) { o.nearest = 1e-4; });
  refused([](DepthFilterOptions& o) { o.farthest = o.nearest; });
  refused([](DepthFilterOptions& o) { o.farthest = HUGE_VAL; });
  refused([](DepthFilterOptions& o) { o.noise = NoiseModel{{-1, 0, 0}, 1}; });
  refused([](DepthFilterOptions& o) { o.noise = NoiseModel{{1e-3, 0, 0}, 0.5}; });
}

TEST(DepthFilter, RefusesFramesThatAreNone) {
  DepthFilter filter;
  const auto refused = [&](auto change) {
    DepthFrame frame = exact_frame({});
    change(frame);
    EXPECT_THROW(filter.filter(frame, Isometry3d::Identity()), Error);
    EXPECT_THROW(filter.filter(frame, Isometry3d::Identity(), {}), Error);
  };
  refused([](DepthFrame& f) { f.depth.pop_back(); });
  refused([](DepthFrame& f) { f.camera.width = 0; });
  refused([](DepthFrame& f) { f.camera.pinhole.fx = 0; });
  refused([](DepthFrame& f) { f.camera.pinhole.cy = std::nan(""); });
  refused([](DepthFrame& f) {
    f.camera.width = f.camera.height = 1;
    f.depth.resize(1);
  });
  for (const std::pair<int, int>& size : {std::pair{4, 4}, {2, 200}, {200, 5}}) {
    refused([&size](DepthFrame& f) {
      f.camera.width = size.first;
      f.camera.height = size.second;
      f.depth.resize(static_cast<std::size_t>(size.first * size.second));
    });
  }
  Isometry3d nowhere = Isometry3d::Identity();
  nowhere.translation().x() = std::nan("");
  EXPECT_THROW(filter.filter(exact_frame({}), nowhere), Error);
  for (const double stretch : {0.0, -1.0, 2.0}) {
    Isometry3d bent = Isometry3d::Identity();
    bent.linear()(2, 2) = stretch;
    EXPECT_THROW(filter.filter(exact_frame({}), bent), Error) << stretch;
  }
}

TEST(DepthFilter, MakesNoPointsOfNothing) {
  for (const auto& [width, height] : {std::pair{6, 6}, {7, 6}, {9, 7}, {160, 120}, {161, 121}}) {
    DepthFrame frame;
    frame.camera = {width, height, {525, 525, width / 2.0, height / 2.0}, {}};
    frame.depth.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    DepthFilter filter;
    const FilteredDepth& out = filter.filter(frame, Isometry3d::Identity());
    EXPECT_EQ(out.columns, width / 2);
    EXPECT_EQ(out.rows, height / 2);
    ASSERT_EQ(out.size(),
              static_cast<std::size_t>(width / 2) * static_cast<std::size_t>(height / 2));
    for (const FilteredDepth::State state : out.states)
      EXPECT_EQ(state, FilteredDepth::State::empty);
  }
}

TEST(DepthFilter, PutsAPlaneWhereItIs) {
  const Vector3d normal = Vector3d(0.1, -0.8, -0.6).normalized();
  const Solid table = plane({0, 0, 0.7}, normal);
  DepthFilter filter(with_noise());
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1, 2, 3);
  const FilteredDepth& out = filter.filter(noisy_frame({table}, {}), pose);
  EXPECT_EQ(out.T_world_sensor.matrix(), pose.matrix());
  EXPECT_NEAR(out.pitch, 2 / 525.0, 1e-12);
  double angle = 0;
  double height = 0;
  double count = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    ASSERT_EQ(out.states[i], FilteredDepth::State::fitted);
    EXPECT_NEAR(out.normals[i].norm(), 1, 1e-5);
    EXPECT_LT(out.normals[i].dot(out.positions[i]), 0);
    EXPECT_GT(out.confidences[i], 0);
    const double off = distance(table, out.positions[i].cast<double>());
    height += off * off;
    angle += std::pow(std::acos(std::min(1.0, out.normals[i].cast<double>().dot(normal))), 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(height / count), 0.1e-3);
  EXPECT_LT(std::sqrt(angle / count), 0.8 * kDegree);  // the image's border has a large share
}

TEST(DepthFilter, TellsHowFarNeighboursAre) {
  const Solid table = plane({0, 0, 0.7}, Vector3d(0, -0.9, -0.435).normalized());
  DepthFilter filter(with_noise());
  const FilteredDepth& out = filter.filter(noisy_frame({table}, {}), Isometry3d::Identity());
  for (int row = 10; row < 50; row += 5) {
    const auto i = static_cast<std::size_t>(row * out.columns + 40);
    const auto below = i + static_cast<std::size_t>(out.columns);
    const float exact = (out.positions[below] - out.positions[i]).norm();
    EXPECT_NEAR(out.spacings[i], exact, 0.1F * exact);
  }
}

TEST(DepthFilter, FitsInTheBallsOnly) {
  const Solid table = plane({0, 0, 0.7}, Vector3d(0, -0.5, -0.8).normalized());
  const DepthFrame frame = noisy_frame({table}, {});
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(0.5, 0, -1);
  const std::vector<Ball> balls = {{pose * Vector3d(0.02, 0, 0.7), 0.03}};
  DepthFilter near(with_noise());
  DepthFilter whole(with_noise());
  const FilteredDepth& some = near.filter(frame, pose, balls);
  const FilteredDepth& all = whole.filter(frame, pose);
  int fitted = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    ASSERT_NE(some.states[i], FilteredDepth::State::empty);
    if (some.states[i] != FilteredDepth::State::fitted) continue;
    ++fitted;
    EXPECT_LT((pose * some.positions[i].cast<double>() - balls[0].center).norm(), 0.036);
    EXPECT_EQ(some.positions[i], all.positions[i]);
    EXPECT_EQ(some.normals[i], all.normals[i]);
  }
  EXPECT_GT(fitted, 100);
  EXPECT_LT(fitted, 600);
}

TEST(DepthFilter, SeesThroughDistortion) {
  CameraModel camera{320, 240, {262, 262, 159.5, 119.5}, {-0.2, 0.05, 0.001, -0.001, 0}};
  const Vector3d normal = Vector3d(0.2, -0.6, -0.8).normalized();
  const Solid table = plane({0, 0, 0.7}, normal);
  DepthFilter filter(with_noise());
  const FilteredDepth& out =
      filter.filter(noisy_frame({table}, {}, 0, camera), Isometry3d::Identity());
  double angle = 0;
  double count = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out.states[i] == FilteredDepth::State::empty) continue;
    EXPECT_NEAR(distance(table, out.positions[i].cast<double>()), 0, 4e-3);
    angle += std::pow(std::acos(std::min(1.0, out.normals[i].cast<double>().dot(normal))), 2);
    ++count;
  }
  EXPECT_GT(count, 0.98 * static_cast<double>(out.size()));
  EXPECT_LT(std::sqrt(angle / count), 0.5 * kDegree);
}

void expect_same_on_four_threads(const std::vector<Solid>& solids) {
  const DepthFrame frame = noisy_frame(solids, {.silhouettes = true});
  const std::vector<Ball> near = {{{0.03, 0, 0.6}, 0.08}};
  for (const bool everywhere : {true, false}) {
    const auto run = [&](std::size_t threads) {
      const ThreadLimit limit(threads);
      DepthFilter filter;
      const Isometry3d pose = Isometry3d::Identity();
      return everywhere ? filter.filter(frame, pose) : filter.filter(frame, pose, near);
    };
    const FilteredDepth one = run(1);
    const FilteredDepth four = run(4);
    EXPECT_EQ(one.states, four.states);
    EXPECT_EQ(one.positions, four.positions);
    EXPECT_EQ(one.normals, four.normals);
    EXPECT_EQ(one.deviations, four.deviations);
  }
}

TEST(DepthFilter, DoesNotDependOnTheNumberOfThreads) {
  const Solid table = plane({0, 0, 0.7}, Vector3d(0, -0.5, -0.8).normalized());
  const Solid wall = plane({0, 0.05, 0.7}, Vector3d(0, -0.8, -0.3).normalized());
  expect_same_on_four_threads({sphere({0.03, 0, 0.6}, 0.06), table});
  expect_same_on_four_threads({table, wall});
}

/// Anything that a file or a driver may hold.
float any_depth(Random& random) {
  const double pick = random.uniform();
  if (pick < 0.55) return static_cast<float>(0.5 + 0.002 * random.normal());
  if (pick < 0.7) return static_cast<float>(30 * random.uniform());
  if (pick < 0.8) return 0;
  if (pick < 0.85) return std::numeric_limits<float>::quiet_NaN();
  if (pick < 0.9) return std::numeric_limits<float>::infinity();
  if (pick < 0.95) return static_cast<float>(std::exp(200 * (random.uniform() - 0.5)));
  return -static_cast<float>(random.uniform());
}

void expect_finite(const FilteredDepth& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out.states[i] == FilteredDepth::State::empty) continue;
    ASSERT_TRUE(out.positions[i].allFinite());
    ASSERT_GT(out.positions[i].z(), 0);
    const float length = out.normals[i].norm();
    ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-4F) << length;
    ASSERT_EQ(length == 0, out.confidences[i] == 0);
    ASSERT_TRUE(out.confidences[i] >= 0 && out.confidences[i] <= 1);
    ASSERT_TRUE(std::isfinite(out.deviations[i]) && out.deviations[i] >= 0);
    ASSERT_TRUE(std::isfinite(out.spacings[i]) && out.spacings[i] > 0);
  }
}

TEST(DepthFilter, IsFiniteWhateverComes) {
  std::ptrdiff_t empty = 0;
  std::ptrdiff_t all = 0;
  for (int repeat = 0; repeat < effort(150); ++repeat) {
    Random random(static_cast<std::uint64_t>(repeat));
    DepthFilterOptions options;
    if (repeat % 2 == 0) options.noise = NoiseModel{{1e-6 + 0.01 * random.uniform(), 0, 0}, 2};
    DepthFilter filter(options);
    DepthFrame frame;
    const int width = 6 + static_cast<int>(56 * random.uniform());
    const int height = 6 + static_cast<int>(56 * random.uniform());
    const double focal = std::exp(std::log(5) + 5 * random.uniform());
    frame.camera = {width, height, {focal, focal * 1.1, width / 2.0, height / 3.0}, {}};
    if (repeat % 3 == 0) frame.camera.distortion = {random.normal(), random.normal(), 0.1, 0.1, 1};
    Isometry3d pose = Isometry3d::Identity();
    for (int number = 0; number < 4; ++number) {
      frame.depth.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
      // A frame where every pixel is in range, and no two agree, bends fits the most.
      const bool rough = repeat % 4 == 1;
      for (float& z : frame.depth) {
        z = rough ? static_cast<float>(0.3 + 3 * random.uniform()) : any_depth(random);
      }
      pose.translation() += 0.1 * Vector3d(random.normal(), random.normal(), random.normal());
      const std::vector<Ball> balls = {{pose * Vector3d(0, 0, 0.5), random.uniform()}};
      const FilteredDepth& out =
          number % 2 == 0 ? filter.filter(frame, pose) : filter.filter(frame, pose, balls);
      expect_finite(out);
      if (HasFatalFailure()) return;
      empty += std::ranges::count(out.states, FilteredDepth::State::empty);
      all += std::ssize(out.states);
    }
  }
  EXPECT_GT(all - empty, all / 10) << "surfaces, of whatever came";
}

}  // namespace
}  // namespace palpate::test
