// Planes and balls through a lens that bends straight lines by tens of pixels.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/numbers.hpp"
#include "depth/input.hpp"
#include "depth/small_frames.hpp"

namespace palpate::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

const CameraModel kStraight{320, 240, {262, 262, 159.5, 119.5}, {}};
const CameraModel kBent{320, 240, kStraight.pinhole, {-0.28, 0.07, 1e-3, 1e-3, 0}};
const NoiseModel kNoise = kinect_like_noise();
const Vector3d kTilted = Vector3d(0.2, -0.6, -0.8).normalized();

using Image = std::vector<float>;

Image undistorted(const Image& image) {
  depth::Undistorter undistorter;
  const float* out = undistorter.undistort(kBent, image, kNoise, {});
  return {out, out + image.size()};
}

/// What the nearest pixels show.
Image nearest(const Image& image) {
  const Pinhole& p = kBent.pinhole;
  Image out;
  for (int v = 0; v < kBent.height; ++v) {
    for (int u = 0; u < kBent.width; ++u) {
      const auto at = depth::distort(kBent.distortion, (u - p.cx) / p.fx, (v - p.cy) / p.fy);
      const auto column = std::lround(at.x * p.fx + p.cx);
      const auto row = std::lround(at.y * p.fy + p.cy);
      const bool inside = column >= 0 && row >= 0 && column < kBent.width && row < kBent.height;
      out.push_back(inside ? image[static_cast<std::size_t>(row * kBent.width + column)] : 0);
    }
  }
  return out;
}

struct ImageErrors {
  double rms = 0;     ///< m
  double ripple = 0;  ///< of the difference between pixels side by side, m
  int count = 0;
};

/// Counts pixels whose true depths are within nearest ... farthest, three on either side included.
ImageErrors errors_of(const Image& image, const Image& truth, float closest, float farthest) {
  ImageErrors errors;
  const auto known = [&](std::size_t i) { return truth[i] >= closest && truth[i] <= farthest; };
  for (std::size_t i = 3; i + 3 < image.size(); ++i) {
    bool inside = true;
    for (std::size_t k = i - 3; k <= i + 3; ++k) inside = inside && known(k) && image[k] > 0;
    if (!inside) continue;
    const double here = image[i] - truth[i];
    const double beside = image[i + 1] - truth[i + 1];
    errors.rms += here * here;
    errors.ripple += (beside - here) * (beside - here);
    ++errors.count;
  }
  errors.rms = std::sqrt(errors.rms / std::max(1, errors.count));
  errors.ripple = std::sqrt(errors.ripple / std::max(1, errors.count));
  return errors;
}

TEST(StrongLens, LeavesAPlaneFlat) {
  const std::vector<Solid> table = {plane({0, 0, 0.7}, kTilted)};
  const Image truth = exact_frame(table, kStraight).depth;
  const Image seen = exact_frame(table, kBent).depth;
  const ImageErrors before = errors_of(nearest(seen), truth, 0.1F, 20);
  const ImageErrors after = errors_of(undistorted(seen), truth, 0.1F, 20);
  EXPECT_GT(after.count, 70000);
  EXPECT_GT(before.rms, 0.5e-3);
  EXPECT_LT(after.rms, before.rms / 50);
  EXPECT_LT(after.ripple, before.ripple / 50);
}

TEST(StrongLens, LeavesASphereRound) {
  const std::vector<Solid> solids = {sphere({0.1, 0.05, 0.6}, 0.15), plane({0, 0, 1}, {0, 0, -1})};
  const Image truth = exact_frame(solids, kStraight).depth;
  const Image seen = exact_frame(solids, kBent).depth;
  const ImageErrors before = errors_of(nearest(seen), truth, 0.1F, 0.53F);
  const ImageErrors after = errors_of(undistorted(seen), truth, 0.1F, 0.53F);
  EXPECT_GT(after.count, 5000);
  EXPECT_LT(after.rms, before.rms / 5);
  EXPECT_LT(after.ripple, before.ripple / 5);
}

// The sphere ends at 0.58 m, the wall stands at 1 m.
int between(const Image& image) {
  return static_cast<int>(
      std::count_if(image.begin(), image.end(), [](float z) { return z > 0.6F && z < 0.97F; }));
}

TEST(StrongLens, PutsNothingBetweenASphereAndTheWallBehindIt) {
  const std::vector<Solid> solids = {sphere({0.1, 0.05, 0.6}, 0.15), plane({0, 0, 1}, {0, 0, -1})};
  EXPECT_EQ(between(undistorted(exact_frame(solids, kBent).depth)), 0);
  // Where the sensor itself does, no more than by nearest pixels.
  const Image flying = noisy_frame(solids, {.silhouettes = true}, 0, kBent).depth;
  EXPECT_GT(between(nearest(flying)), 100);
  EXPECT_LE(between(undistorted(flying)), between(nearest(flying)));
}

TEST(StrongLens, ShowsNothingWhereTheNearestPixelDoes) {
  Image image = exact_frame({plane({0, 0, 0.7}, kTilted)}, kBent).depth;
  Random random(1);
  const float none[] = {0, -1, 30, std::numeric_limits<float>::quiet_NaN(),
                        std::numeric_limits<float>::infinity()};
  for (float& z : image) {
    if (random.uniform() < 0.3) z = none[static_cast<int>(5 * random.uniform())];
  }
  const Image expected = nearest(image);
  const Image out = undistorted(image);
  ASSERT_EQ(out.size(), image.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool measured = expected[i] >= 0.1F && expected[i] <= 20;
    ASSERT_EQ(out[i] > 0, measured);
    ASSERT_NEAR(out[i], measured ? expected[i] : 0, 0.01 * out[i]);
  }
}

// What a fit takes for the noise has to fit what it sees, with the lens as without one.
TEST(StrongLens, KeepsTheNoiseHonest) {
  const Solid table = plane({0, 0, 0.7}, kTilted);
  const auto ratio = [&](const CameraModel& camera) {
    DepthFilter filter({.memory = 1});
    const FilteredDepth& out =
        filter.filter(noisy_frame({table}, {}, 0, camera), Isometry3d::Identity());
    EXPECT_NEAR(out.noise.sigma(0.7) / kNoise.sigma(0.7), 1, 0.15);
    double squares = 0;
    double count = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (out.states[i] != FilteredDepth::State::fitted) continue;
      const Vector3d at = out.positions[i].cast<double>();
      const double along = distance(table, at) / std::abs(kTilted.dot(at.normalized()));
      squares += std::pow(along / static_cast<double>(out.deviations[i]), 2);
      ++count;
    }
    EXPECT_GT(count, 0.95 * static_cast<double>(out.size()));
    return std::sqrt(squares / count);
  };
  EXPECT_NEAR(ratio(kBent), ratio(kStraight), 0.15 * ratio(kStraight));
}

}  // namespace
}  // namespace palpate::test
