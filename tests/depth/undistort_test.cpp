#include <gtest/gtest.h>

#include <cmath>

#include "depth/input.hpp"

namespace palpate::test {
namespace {

const CameraModel kPlain{80, 60, {60, 62, 39.5, 29.5}, {}};
const CameraModel::Distortion kBarrel{-0.25, 0.08, 0.001, -0.002, -0.01};
const NoiseModel kMillimetreNoise{{1e-3, 0, 0}, 1};

TEST(Undistort, LeavesImagesWithoutDistortionAlone) {
  std::vector<float> image(80 * 60, 1.5F);
  depth::Undistorter undistorter;
  EXPECT_EQ(undistorter.undistort(kPlain, image, kMillimetreNoise, {}), image.data());
}

TEST(Undistort, FollowsBrownAndConrady) {
  const CameraModel::Distortion radial{0.1, 0.01, 0, 0, 0.001};
  const depth::ImagePoint at = depth::distort(radial, 0.5, 0);
  EXPECT_NEAR(at.x, 0.5 * (1 + 0.1 * 0.25 + 0.01 * 0.0625 + 0.001 * 0.015625), 1e-12);
  EXPECT_EQ(at.y, 0);
  const depth::ImagePoint tangential = depth::distort({0, 0, 0.01, 0.02, 0}, 0.3, 0.4);
  EXPECT_NEAR(tangential.x, 0.3 + 2 * 0.01 * 0.12 + 0.02 * (0.25 + 2 * 0.09), 1e-12);
  EXPECT_NEAR(tangential.y, 0.4 + 2 * 0.02 * 0.12 + 0.01 * (0.25 + 2 * 0.16), 1e-12);
}

// Inverse depth that is affine in the distorted image tells where a pixel comes from.
TEST(Undistort, TakesEveryPixelFromWhereTheLensPutIt) {
  CameraModel camera = kPlain;
  camera.distortion = kBarrel;
  const auto rho = [](double u, double v) { return 0.8 + 3e-4 * u + 2e-4 * v; };
  std::vector<float> image;
  for (int i = 0; i < 80 * 60; ++i) {
    image.push_back(
        static_cast<float>(1 / rho(i % 80, i / 80)));  // NOLINT(bugprone-integer-division)
  }
  depth::Undistorter undistorter;
  const float* out = undistorter.undistort(camera, image, kMillimetreNoise, {});
  for (int v = 0; v < 60; ++v) {
    for (int u = 0; u < 80; ++u) {  // a barrel shows more than the image without distortion holds
      const auto at = depth::distort(kBarrel, (u - 39.5) / 60, (v - 29.5) / 62);
      EXPECT_NEAR(1 / out[v * 80 + u], rho(at.x * 60 + 39.5, at.y * 62 + 29.5), 1e-6);
    }
  }
}

TEST(Undistort, IsEmptyWhereTheCameraSawNothing) {
  CameraModel camera = kPlain;
  camera.distortion.k1 = 0.4;  // a pincushion's corners lie outside of the image
  const std::vector<float> image(80 * 60, 2.0F);
  depth::Undistorter undistorter;
  const float* out = undistorter.undistort(camera, image, kMillimetreNoise, {});
  EXPECT_EQ(out[0], 0);
  EXPECT_EQ(out[30 * 80 + 40], 2);
}

TEST(Undistort, IsEmptyWhereTheModelFoldsBack) {
  CameraModel camera = kPlain;
  camera.distortion.k1 = -1.5;  // grows no more from r = 0.47 on
  const std::vector<float> image(80 * 60, 2.0F);
  depth::Undistorter undistorter;
  const float* out = undistorter.undistort(camera, image, kMillimetreNoise, {});
  EXPECT_EQ(out[0], 0);
  EXPECT_EQ(out[30 * 80 + 5], 0);
  EXPECT_EQ(out[30 * 80 + 40], 2);
}

TEST(Undistort, NoticesAnotherCamera) {
  CameraModel camera = kPlain;
  camera.distortion = kBarrel;
  std::vector<float> image(80 * 60, 1.0F);
  depth::Undistorter undistorter;
  EXPECT_EQ(undistorter.undistort(camera, image, kMillimetreNoise, {})[0], 1);
  camera.distortion = {0.4, 0, 0, 0, 0};
  EXPECT_EQ(undistorter.undistort(camera, image, kMillimetreNoise, {})[0], 0);
}

}  // namespace
}  // namespace palpate::test
