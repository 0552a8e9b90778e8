#include "message/point_clouds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "palpate/base/error.hpp"

namespace palpate::message {
namespace {

// Two points of x, y, z in float64 behind four bytes of something else, and a packed colour.
PointCloud2 cloud(bool big_endian = false) {
  PointCloud2 message;
  message.width = 2;
  message.point_step = 36;
  message.row_step = 72;
  message.is_bigendian = big_endian;
  message.fields = {
      {"y", 12, 8, 1}, {"x", 4, 8, 1}, {"z", 20, 8, 1}, {"rgb", 28, 7, 1}, {"ring", 32, 4, 1}};
  message.data.resize(72);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto put = [&](std::size_t offset, auto value) {
      auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(value)>>(value);
      if (big_endian) std::ranges::reverse(bytes);
      std::memcpy(message.data.data() + 36 * i + offset, bytes.data(), bytes.size());
    };
    put(4, 1.0 + static_cast<double>(i));
    put(12, 2.0);
    put(20, 3.0);
    put(28, std::uint32_t{0x00102030});
  }
  return message;
}

TEST(PointClouds, TakesAnyLayoutOfFieldsAndEitherByteOrder) {
  for (const bool big : {false, true}) {
    const PointCloud read = cloud_of(cloud(big));
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read.point(1), Eigen::Vector3d(2, 2, 3));
    EXPECT_EQ(read.colors[0], (std::array<std::uint8_t, 3>{0x10, 0x20, 0x30}));
    EXPECT_TRUE(read.viewpoint);
  }
}

TEST(PointClouds, DropsPointsThatAreNone) {
  PointCloud2 message = cloud();
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::memcpy(message.data.data() + 4, &none, 8);
  EXPECT_EQ(cloud_of(message).size(), 1U);
  std::memcpy(message.data.data() + 40, &none, 8);
  EXPECT_EQ(cloud_of(message).size(), 0U);
  message.width = message.height = 0;
  message.data.clear();
  EXPECT_EQ(cloud_of(message).size(), 0U);
}

TEST(PointClouds, KeepsPixelsOfOrganisedOnes) {
  PointCloud2 message = cloud();
  message.width = 1;
  message.height = 2;
  message.row_step = 36;
  const PointCloud read = cloud_of(message);
  EXPECT_EQ(read.width, 1U);
  EXPECT_EQ(read.height, 2U);
  EXPECT_THAT(read.pixels, testing::ElementsAre(0, 1));
}

TEST(PointClouds, TakesOneRowThatDoesNotSayHowLongItIs) {
  PointCloud2 message = cloud();
  message.row_step = 0;
  const PointCloud read = cloud_of(message);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read.point(1), Eigen::Vector3d(2, 2, 3));
}

TEST(PointClouds, RefusesThoseThatContradictThemselves) {
  const auto refused = [](auto&& spoil) {
    PointCloud2 message = cloud();
    spoil(message);
    EXPECT_THROW(static_cast<void>(cloud_of(message)), Error);
  };
  refused([](PointCloud2& m) { m.point_step = 0; });
  refused([](PointCloud2& m) { m.row_step = 0, m.height = 2, m.width = 1; });
  refused([](PointCloud2& m) { m.row_step = 0, m.width = 3; });
  refused([](PointCloud2& m) { m.row_step = 10; });
  refused([](PointCloud2& m) { m.width = 1U << 31U; });
  refused([](PointCloud2& m) { m.height = 1U << 31U; });
  refused([](PointCloud2& m) { m.height = 0xffffffff, m.width = 0xffffffff; });
  refused([](PointCloud2& m) { m.data.resize(71); });
  refused([](PointCloud2& m) { m.fields[0].offset = 30; });
  refused([](PointCloud2& m) { m.fields[0].offset = 0xfffffffc; });
  refused([](PointCloud2& m) { m.fields[0].datatype = 9; });
  refused([](PointCloud2& m) { m.fields[0].datatype = 0; });
  refused([](PointCloud2& m) { m.fields.erase(m.fields.begin()); });
}

TEST(PointClouds, GiveBackTheCloudThatTheyWereMadeOf) {
  PointCloud made;
  made.positions = {{1, 2, 3}, {4, 5, 6}};
  made.normals = {{0, 0, 1}, {1, 0, 0}};
  const PointCloud read = cloud_of(message_of(made));
  EXPECT_EQ(read.positions, made.positions);
  EXPECT_EQ(read.normals, made.normals);
}

}  // namespace
}  // namespace palpate::message
