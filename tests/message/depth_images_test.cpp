#include "message/depth_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "palpate/base/error.hpp"

namespace palpate::message {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

CameraInfo info(const std::string& model, std::vector<double> d) {
  CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = model;
  info.d = std::move(d);
  info.k = {500, 0, 320, 0, 510, 240, 0, 0, 1};
  info.p = {400, 0, 310, 0, 0, 410, 230, 0, 0, 0, 1, 0};
  return info;
}

Image image(const std::string& encoding, std::vector<std::uint8_t> data) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(data.size());
  image.data = std::move(data);
  return image;
}

TEST(DepthImages, TakesMillimetresOfEitherByteOrder) {
  DepthFrame frame;
  read_depth(image("16UC1", {0xe8, 0x03, 0, 0}), frame);
  EXPECT_THAT(frame.depth, ElementsAre(1, 0));
  Image big = image("16UC1", {0x03, 0xe8, 0, 0});
  big.is_bigendian = 1;
  read_depth(big, frame);
  EXPECT_THAT(frame.depth, ElementsAre(1, 0));
}

TEST(DepthImages, TakesMetresAndMakesNothingOfWhatIsNone) {
  const std::array<float, 2> depths{1.25F, std::numeric_limits<float>::quiet_NaN()};
  std::vector<std::uint8_t> bytes(8);
  std::memcpy(bytes.data(), depths.data(), 8);
  DepthFrame frame;
  read_depth(image("32FC1", bytes), frame);
  EXPECT_THAT(frame.depth, ElementsAre(1.25F, 0));
}

TEST(DepthImages, SkipsWhatPadsARow) {
  Image padded = image("16UC1", {1, 0, 2, 0, 99, 99, 3, 0, 4, 0, 99, 99});
  padded.height = 2;
  padded.step = 6;
  DepthFrame frame;
  read_depth(padded, frame);
  EXPECT_THAT(frame.depth, ElementsAre(0.001F, 0.002F, 0.003F, 0.004F));
}

TEST(DepthImages, RefusesImagesThatAreNoDepthOrContradictThemselves) {
  DepthFrame frame;
  EXPECT_THAT(
      [&] {
        read_depth(image("rgb8", {0, 0, 0, 0, 0, 0}), frame);
      },
      ThrowsMessage<Error>(HasSubstr("'rgb8'")));
  Image cut = image("16UC1", {1, 0, 2, 0});
  cut.height = 2;
  EXPECT_THROW(read_depth(cut, frame), Error);
  cut.step = 0;
  EXPECT_THROW(read_depth(cut, frame), Error);
  Image huge = image("16UC1", {});
  huge.width = 1U << 31U;
  huge.step = 0xffffffff;
  EXPECT_THROW(read_depth(huge, frame), Error);
}

TEST(DepthImages, KnowsTheTopicBesideThem) {
  EXPECT_EQ(info_topic("/camera/depth/image_rect_raw"), "/camera/depth/camera_info");
  EXPECT_EQ(info_topic("/camera/depth/image_raw/compressedDepth"), "/camera/depth/camera_info");
  EXPECT_TRUE(is_rectified("/camera/depth/image_rect_raw"));
  EXPECT_TRUE(is_rectified("/camera/depth/image_rect/compressedDepth"));
  EXPECT_FALSE(is_rectified("/rect/depth/image_raw"));
  EXPECT_EQ(info_topic("/compressed_camera/depth/image"), "/compressed_camera/depth/camera_info");
}

TEST(CameraOf, TakesThePinholeOfRectifiedImagesFromP) {
  const CameraModel raw = camera_of(info("plumb_bob", {0.1, 0, 0, 0, 0}), false);
  EXPECT_EQ(raw.pinhole.fx, 500);
  EXPECT_EQ(raw.distortion.k1, 0.1);
  const CameraModel rectified = camera_of(info("plumb_bob", {0.1, 0, 0, 0, 0}), true);
  EXPECT_EQ(rectified.pinhole.fx, 400);
  EXPECT_EQ(rectified.pinhole.cy, 230);
  EXPECT_TRUE(rectified.distortion.none());
}

TEST(CameraOf, FollowsBinningAndRegionOfInterest) {
  CameraInfo told = info("plumb_bob", {});
  told.binning_x = told.binning_y = 2;
  told.roi = {.x_offset = 20, .y_offset = 40, .height = 400, .width = 600, .do_rectify = false};
  const CameraModel camera = camera_of(told, false);
  EXPECT_EQ(camera.width, 300);
  EXPECT_EQ(camera.height, 200);
  EXPECT_EQ(camera.pinhole.fx, 250);
  EXPECT_EQ(camera.pinhole.cx, 150);
  EXPECT_EQ(camera.pinhole.cy, 100);
}

// The polynomial that takes the place of a rational lens moves no ray by a pixel or more.
TEST(CameraOf, FollowsARationalLens) {
  const std::vector<double> d{0.5, -0.1, 0, 0, 0.02, 0.45, -0.05, 0.01};
  const CameraModel camera = camera_of(info("rational_polynomial", d), false);
  for (double r = 0; r < 0.8; r += 0.05) {
    const double s = r * r;
    const double wanted =
        r * (1 + s * (d[0] + s * (d[1] + s * d[4]))) / (1 + s * (d[5] + s * (d[6] + s * d[7])));
    const auto& k = camera.distortion;
    EXPECT_NEAR(500 * r * (1 + s * (k.k1 + s * (k.k2 + s * k.k3))), 500 * wanted, 1) << r;
  }
}

TEST(CameraOf, RefusesLensesThatItCannotFollow) {
  EXPECT_THAT(
      [] {
        static_cast<void>(camera_of(info("equidistant", {0.1, 0, 0, 0}), false));
      },
      ThrowsMessage<Error>(HasSubstr("'equidistant'")));
  EXPECT_THROW(static_cast<void>(camera_of(info("plumb_bob", {0.1}), false)), Error);
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(
      [&] {
        static_cast<void>(camera_of(info("plumb_bob", {0.1, none, 0, 0}), false));
      },
      ThrowsMessage<Error>(HasSubstr("not finite")));
  CameraInfo uncalibrated = info("plumb_bob", {});
  uncalibrated.k = {};
  EXPECT_THAT([&] { static_cast<void>(camera_of(uncalibrated, false)); },
              ThrowsMessage<Error>(HasSubstr("calibrated")));
  CameraInfo broken = info("plumb_bob", {});
  broken.k[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(camera_of(broken, false)), Error);
}

TEST(DepthImages, GiveBackTheFrameThatTheyWereMadeOf) {
  DepthFrame frame;
  frame.camera = {
      .width = 2, .height = 1, .pinhole = {500, 510, 0.5, 0.25}, .distortion = {.k1 = 0.1}};
  frame.depth = {1.5F, 0};
  DepthFrame read;
  read.camera = camera_of(info_of(frame.camera), false);
  read_depth(image_of(frame), read);
  EXPECT_EQ(read.depth, frame.depth);
  EXPECT_EQ(read.camera.pinhole.fy, 510);
  EXPECT_EQ(read.camera.distortion.k1, 0.1);
}

TEST(CompressedDepth, RefusesWhatItCannotUnpack) {
  DepthFrame frame;
  CompressedImage compressed;
  compressed.format = "16UC1; compressedDepth rvl";
  EXPECT_THAT([&] { read_depth(compressed, frame); }, ThrowsMessage<Error>(HasSubstr("RVL")));
  compressed.format = "16UC1; compressedDepth png";
  EXPECT_THROW(read_depth(compressed, frame), Error);
  compressed.data.assign(40, 7);
  EXPECT_THROW(read_depth(compressed, frame), Error);
}

}  // namespace
}  // namespace palpate::message
