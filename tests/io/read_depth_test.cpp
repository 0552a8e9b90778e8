#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "io/reading.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"

namespace palpate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const ReadDepthOptions kDepthOptions{
    .camera = {.width = 0, .height = 0, .pinhole = {100, 200, 1, 0.5}, .distortion = {.k1 = 0.1}}};

std::string pgm(int width, int height, const std::vector<std::uint16_t>& values,
                std::endian order = std::endian::big) {
  std::string bytes = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 65535\n";
  for (const std::uint16_t v : values) append(bytes, v, order);
  return bytes;
}

DepthFrame read(const std::string& bytes, const ReadDepthOptions& options = kDepthOptions) {
  return read_depth_frame_bytes(std::as_bytes(std::span(bytes)), "a", options);
}

std::string refusal_of(const std::string& bytes, const ReadDepthOptions& options = kDepthOptions) {
  try {
    (void)read(bytes, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A slanted plane of 64 x 64 pixels, around 1 m in millimetres.
std::vector<std::uint16_t> plane() {
  std::vector<std::uint16_t> values;
  for (int i = 0; i < 64 * 64; ++i) {
    values.push_back(static_cast<std::uint16_t>(900 + 3 * (i % 64) + i / 64));
  }
  return values;
}

TEST(ReadDepth, GivesMetresAndTheCamera) {
  const DepthFrame frame = read(pgm(3, 2, {1000, 0, 65535, 258, 2000, 60000}));
  EXPECT_EQ(frame.camera.width, 3);
  EXPECT_EQ(frame.camera.height, 2);
  EXPECT_EQ(frame.camera.pinhole.fy, 200);
  EXPECT_EQ(frame.camera.distortion.k1, 0.1);
  EXPECT_THAT(frame.depth, ElementsAre(1.0F, 0.0F, 0.0F, 0.258F, 2.0F, 60.0F));
  EXPECT_TRUE(frame.colors.empty());
  EXPECT_FALSE(frame.T_world_sensor);
}

TEST(ReadDepth, HonoursUnitAndInvalidValues) {
  ReadDepthOptions options = kDepthOptions;
  options.depth_unit = 2e-4;
  options.invalid = {7, 9};
  EXPECT_THAT(read(pgm(4, 1, {7, 8, 9, 5000}), options).depth, ElementsAre(0, 1.6e-3F, 0, 1.0F));
  EXPECT_THAT(read("P5 3 1 1000\n" + std::string("\x3\xe7\x3\xe8\x3\xe9"), kDepthOptions).depth,
              ElementsAre(0.999F, 0, 0));
}

TEST(ReadDepth, LooksAtTheSize) {
  ReadDepthOptions options = kDepthOptions;
  options.camera.width = 3;
  options.camera.height = 1;
  EXPECT_EQ(read(pgm(3, 1, {1, 2, 3}), options).depth.size(), 3u);
  EXPECT_THAT(refusal_of(pgm(1, 3, {1, 2, 3}), options),
              HasSubstr("1 x 3 pixels, but the camera has 3 x 1"));
}

TEST(ReadDepth, AsksForCameraAndUnit) {
  EXPECT_THAT(refusal_of(pgm(1, 1, {1}), {}), HasSubstr("without camera intrinsics"));
  ReadDepthOptions options = kDepthOptions;
  options.depth_unit = -1;
  EXPECT_THAT(refusal_of(pgm(1, 1, {1}), options), HasSubstr("depth unit"));
  options = kDepthOptions;
  options.camera.pinhole.cx = std::nan("");
  EXPECT_THAT(refusal_of(pgm(1, 1, {1}), options), HasSubstr("are invalid"));
}

TEST(ReadDepth, RefusesWhatIsNoDepthImage) {
  EXPECT_THAT(refusal_of("1 2 3\n"), HasSubstr("not a depth image"));
  EXPECT_THAT(refusal_of(""), HasSubstr("empty"));
  EXPECT_THAT(refusal_of("P5 2 2 65535\nab"), HasSubstr("after 1 of 4 pixels"));
}

TEST(ReadDepth, FindsSwappedBytes) {
  const std::string swapped = pgm(64, 64, plane(), std::endian::little);
  EXPECT_THAT(refusal_of(swapped), HasSubstr("swapped"));
  ReadDepthOptions options = kDepthOptions;
  options.swapped = true;
  const DepthFrame right = read(pgm(64, 64, plane()));
  EXPECT_EQ(read(swapped, options).depth, right.depth);
}

TEST(ReadDepth, TakesCoarseAndNoisyImagesForRightOnes) {
  std::vector<std::uint16_t> coarse = plane();
  for (std::uint16_t& v : coarse) v = static_cast<std::uint16_t>((v - 890) / 8 * 256);
  EXPECT_EQ(refusal_of(pgm(64, 64, coarse)), "no error");
  std::vector<std::uint16_t> noise;
  std::uint32_t state = 1;
  for (int i = 0; i < 64 * 64; ++i) {
    state = state * 1664525U + 1013904223U;
    noise.push_back(static_cast<std::uint16_t>(state >> 16U));
  }
  EXPECT_EQ(refusal_of(pgm(64, 64, noise)), "no error");
}

TEST(ReadDepth, AFrameThatCannotBeReadLeavesTheOldOne) {
  DepthFrame frame = read(pgm(2, 1, {1, 2}));
  const DepthFrame before = frame;
  EXPECT_THROW(read_depth_frame("/absent.png", kDepthOptions, frame), Error);
  EXPECT_EQ(frame.depth, before.depth);
}

// Real images, as they are: none looks swapped.
TEST(ReadDepth, TakesEveryRealImage) {
  const char* folder = std::getenv("PALPATE_DATA");
  if (folder == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  std::size_t images = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const bool depth = entry.path().string().find("depth") != std::string::npos;
    if (!depth || entry.path().extension() != ".png") continue;
    if (++images % 10 != 0) continue;
    EXPECT_EQ(read_depth_frame(entry.path(), kDepthOptions).depth.size(), 640u * 480u)
        << entry.path();
  }
  EXPECT_GT(images, 100u);
}

}  // namespace
}  // namespace palpate
