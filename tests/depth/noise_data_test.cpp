// The noise of real sensors' frames, beside what was measured of such sensors before,
// and what the filters make of it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "depth/noise_tracker.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/io/files.hpp"

namespace palpate {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

class NoiseDataTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("PALPATE_DATA");
    if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
    folder_ = data;
  }

  /// Puts a file's points back into the pixels that they came from; empty: there is no such file.
  [[nodiscard]] std::vector<float> image(const std::string& name, double focal, double cx,
                                         double cy) const {
    std::vector<float> depth;
    if (!std::filesystem::exists(folder_ / name)) return depth;
    ReadOptions options;
    options.intrinsics = Pinhole{focal, focal, cx, cy};
    const PointCloud cloud = read_cloud(folder_ / name, options);
    depth.resize(kWidth * kHeight);
    for (const Eigen::Vector3f& p : cloud.positions) {
      const Eigen::Vector3d q = p.cast<double>() + cloud.origin;
      const auto u = std::lround(q.x() / q.z() * focal + cx);
      const auto v = std::lround(q.y() / q.z() * focal + cy);
      if (u < 0 || v < 0 || u >= kWidth || v >= kHeight) continue;
      depth[static_cast<std::size_t>(v * kWidth + u)] = static_cast<float>(q.z());
    }
    return depth;
  }

  [[nodiscard]] std::vector<float> realsense(int number) const {
    return image(fmt::format("realsense_makerspace_mit/depth/{:06}.png", number), 383.8, 321.7,
                 236.8);
  }

  std::filesystem::path folder_;
};

depth::DepthView view_of(const std::vector<float>& depth, double focal) {
  return {depth, kWidth, kHeight, focal, 0.1F, 20};
}

// Measured there from differences of frames: sigma = 2.47 z^2 mm, n_c = 80 to 126 in tiles of 16
// and 32 pixels, which cut it short: c from 9 on.
TEST_F(NoiseDataTest, ARealSensesNoiseIsThatOfItsKind) {
  const std::vector<float> first = realsense(80);
  if (first.empty()) GTEST_SKIP() << "no RealSense frames in PALPATE_DATA";
  depth::NoiseTracker tracker(unknown_sensor_noise());
  for (int number = 80; number < 100; ++number) {
    const std::vector<float> depth = realsense(number);
    const NoiseModel& model = tracker.update(view_of(depth, 383.8));
    ASSERT_GT(model.sigma(1), 0.8 * 2.47e-3);
    ASSERT_LT(model.sigma(1), 1.6 * 2.47e-3);
    ASSERT_GT(model.correlation, 9);
    ASSERT_LT(model.correlation, 17);
  }
}

// There, from differences: 1.1 to 1.3 mm at a metre, n_c 16 to 28. One frame shows the fixed
// pattern besides.
TEST_F(NoiseDataTest, AKinectsNoiseIsThatOfItsKind) {
  const std::vector<float> depth = image("pcl_tabletop/osd_test0.pcd", 525, 319.5, 239.5);
  if (depth.empty()) GTEST_SKIP() << "no Kinect frames in PALPATE_DATA";
  depth::NoiseTracker tracker(unknown_sensor_noise());
  const NoiseModel& model = tracker.update(view_of(depth, 525));
  EXPECT_GT(model.sigma(1), 1.1e-3);
  EXPECT_LT(model.sigma(1), 2.5e-3);
  EXPECT_GT(model.correlation, 3);
  EXPECT_LT(model.correlation, 8);
}

/// Median over the blocks that are fitted in all of the frames, of the deviation of z / z^2 (mm at
/// a metre) over the last eight.
double deviation_over_time(const std::vector<std::vector<float>>& frames, int memory) {
  DepthFilter filter({.memory = memory});
  std::vector<std::vector<float>> depths;
  for (const std::vector<float>& image : frames) {
    DepthFrame frame;
    frame.camera = {kWidth, kHeight, {383.8, 383.8, 321.7, 236.8}, {}};
    frame.depth = image;
    const FilteredDepth& out = filter.filter(frame, Eigen::Isometry3d::Identity());
    depths.emplace_back(out.size(), 0.0F);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (out.states[i] == FilteredDepth::State::fitted) depths.back()[i] = out.positions[i].z();
    }
  }
  std::vector<double> deviations;
  const std::size_t first = depths.size() - 8;
  for (std::size_t i = 0; i < depths[0].size(); ++i) {
    double sum = 0;
    double squares = 0;
    bool always = true;
    for (std::size_t k = first; k < depths.size(); ++k) {
      const double z = depths[k][i];
      always = always && z > 0 && z < 2;
      sum += z;
      squares += z * z;
    }
    if (!always) continue;
    const double mean = sum / 8;
    deviations.push_back(1e3 * std::sqrt(std::max(0.0, squares / 8 - mean * mean)) / (mean * mean));
  }
  std::nth_element(deviations.begin(), deviations.begin() + deviations.size() / 2,
                   deviations.end());
  return deviations[deviations.size() / 2];
}

// While the robot with the RealSense stands still.
TEST_F(NoiseDataTest, TheFilterOverTimeStillsAStillScene) {
  std::vector<std::vector<float>> frames;
  for (int number = 142; number < 155; ++number) frames.push_back(realsense(number));
  if (frames.front().empty()) GTEST_SKIP() << "no RealSense frames in PALPATE_DATA";
  EXPECT_LT(deviation_over_time(frames, 8), 0.4 * deviation_over_time(frames, 1));
}

}  // namespace
}  // namespace palpate
