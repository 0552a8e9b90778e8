#include "io/depth_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

const ReadOptions kOptions{.intrinsics = Pinhole{.fx = 100, .fy = 200, .cx = 1, .cy = 0.5}};

std::string samples(const std::vector<std::uint16_t>& values) {
  std::string bytes;
  for (const std::uint16_t v : values) append(bytes, v, std::endian::big);
  return bytes;
}

std::string chunk(const std::string& kind, const std::string& data) {
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(data.size()), std::endian::big);
  const std::string body = kind + data;
  bytes += body;
  const auto* begin = reinterpret_cast<const Bytef*>(body.data());
  append(bytes, static_cast<std::uint32_t>(crc32(0, begin, static_cast<uInt>(body.size()))),
         std::endian::big);
  return bytes;
}

std::string png(std::uint32_t width, std::uint32_t height, int bits, const std::string& rows) {
  std::string header;
  append(header, width, std::endian::big);
  append(header, height, std::endian::big);
  header += static_cast<char>(bits) + std::string(4, '\0');
  std::string packed(1000, '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(rows.data()), static_cast<uLong>(rows.size()));
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", packed) + chunk("IEND", "");
}

const std::vector<std::uint16_t> kFirst{1000, 0, 65535};
const std::vector<std::uint16_t> kSecond{258, 2000, 60000};

void expect_points(const CloudFile& file) {
  ASSERT_EQ(file.cloud.size(), 3u);
  EXPECT_EQ(file.cloud.width, 3u);
  EXPECT_EQ(file.cloud.height, 2u);
  EXPECT_EQ(file.declared, 6u);
  EXPECT_EQ(file.dropped, 3u);  // 0, 65535, and 60 m beyond a median of 1 m
  EXPECT_TRUE(file.cloud.point(0).isApprox(Eigen::Vector3d(-0.01, -0.0025, 1), 1e-6));
  EXPECT_TRUE(file.cloud.point(1).isApprox(Eigen::Vector3d(-0.00258, 0.000645, 0.258), 1e-6));
  EXPECT_TRUE(file.cloud.point(2).isApprox(Eigen::Vector3d(0, 0.005, 2), 1e-6));
  EXPECT_EQ(file.cloud.viewpoint, Eigen::Vector3d(0, 0, 0));
}

TEST(DepthImage, ReadsPngOfSixteenBits) {
  const std::string rows = std::string(1, '\0') + samples(kFirst) + '\0' + samples(kSecond);
  expect_points(read_text(png(3, 2, 16, rows), "a.png", kOptions));
}

TEST(DepthImage, ReadsPgmWithTheMoreSignificantByteFirst) {
  expect_points(read_text(
      "P5\n# by hand\n3 2\n# more\n65535\n" + samples(kFirst) + samples(kSecond), "a", kOptions));
}

TEST(DepthImage, TheLargestValueOfAPgmIsNoDepth) {
  const CloudFile file =
      read_text("P5 4 1 1000\n" + samples({999, 1000, 1001, 998}), "a", kOptions);
  EXPECT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.dropped, 2u);
}

TEST(DepthImage, HonoursUnitAndScale) {
  ReadOptions options = kOptions;
  options.depth_unit = 1e-4;
  options.scale = 2;
  EXPECT_NEAR(read_text("P5 1 1 65535\n" + samples({5000}), "a", options).cloud.point(0).z(), 1.0,
              1e-7);
}

TEST(DepthImage, AsksForTheCamera) {
  EXPECT_THAT(refusal("P5 1 1 65535\n" + samples({5000})), HasSubstr("--intrinsics fx,fy,cx,cy"));
  ReadOptions options = kOptions;
  options.intrinsics->fx = 0;
  EXPECT_THAT(refusal("P5 1 1 65535\nab", "a", options), HasSubstr("are invalid"));
  options = kOptions;
  options.depth_unit = 0;
  EXPECT_THAT(refusal("P5 1 1 65535\nab", "a", options), HasSubstr("depth unit of 0"));
}

TEST(DepthImage, RefusesPictures) {
  EXPECT_THAT(refusal(png(2, 1, 8, std::string(3, '\0')), "a", kOptions),
              HasSubstr("a picture (PNG, 8 bits)"));
  EXPECT_THAT(refusal("P5 2 1 255\nab", "a", kOptions), HasSubstr("values up to 255"));
}

TEST(DepthImage, RefusesCutAndOversizedImages) {
  EXPECT_THAT(refusal("P5 2 2 65535\n" + samples({1, 2, 3}), "a", kOptions),
              HasSubstr("after 3 of 4 pixels"));
  EXPECT_THAT(refusal("P5 60000 60000 65535\nab", "a", kOptions), HasSubstr("too many for"));
  EXPECT_THAT(refusal("P5 60000", "a", kOptions), HasSubstr("lacks its height"));
  const std::string image = png(3, 1, 16, std::string(1, '\0') + samples(kFirst));
  constexpr std::size_t kBehindPixels = 4 + 12;  // a checksum and the closing chunk
  for (std::size_t size = 8; size + kBehindPixels < image.size(); ++size) {
    EXPECT_NE(refusal(image.substr(0, size), "a", kOptions), "no error") << size;
  }
  EXPECT_THAT(refusal(png(60000, 60000, 16, "abc"), "a", kOptions), HasSubstr("too many for"));
  EXPECT_THAT(refusal("P5 2 1 65535\n" + samples({0, 65535}), "a", kOptions),
              HasSubstr("none of the 2 points"));
}

}  // namespace
}  // namespace palpate
