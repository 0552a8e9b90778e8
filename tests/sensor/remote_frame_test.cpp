// The protocol of docs/remote_camera.md as bytes alone.
#include "sensor/remote_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "palpate/base/error.hpp"
#include "sensor/remote_sender.hpp"
#include "support/contains.hpp"

namespace palpate::sensor {
namespace {

using test::RemoteFrame;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every frame of `bytes`, given in pieces of `piece` bytes.
std::vector<DepthFrame> frames_of(std::span<const std::byte> bytes, std::size_t piece) {
  FrameAssembler assembler;
  std::vector<DepthFrame> frames;
  while (!bytes.empty()) {
    const std::span<std::byte> room = assembler.room();
    const std::size_t count = std::min({piece, room.size(), bytes.size()});
    std::ranges::copy(bytes.first(count), room.begin());
    bytes = bytes.subspan(count);
    if (assembler.add(count)) assembler.take(frames.emplace_back());
  }
  return frames;
}

DepthFrame only(const RemoteFrame& sent) {
  const std::vector<DepthFrame> frames = frames_of(sent.bytes(), 1000);
  EXPECT_EQ(frames.size(), 1u);
  return frames.empty() ? DepthFrame{} : frames.front();
}

FrameHeader header_of(const RemoteFrame& sent) {
  const std::vector<std::byte> bytes = sent.bytes();
  return parse_frame_header(std::span(bytes).first(kFrameHeaderSize));
}

std::string complaint(const RemoteFrame& sent) {
  try {
    (void)header_of(sent);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(RemoteFrame, IsReadAsItWasSent) {
  RemoteFrame sent;
  sent.flags = 3;
  sent.distortion = {0.1, -0.2, 0.01, -0.02, 0.05};
  sent.stamp = 1234.5;
  sent.pose = {1, -2, 3, 0, std::sqrt(0.5), 0, std::sqrt(0.5)};
  const FrameHeader header = header_of(sent);
  EXPECT_EQ(header.camera.width, 8);
  EXPECT_EQ(header.camera.height, 6);
  EXPECT_EQ(header.camera.pinhole.fx, 8);
  EXPECT_EQ(header.camera.pinhole.fy, 8.5);
  EXPECT_EQ(header.camera.pinhole.cx, 3.5);
  EXPECT_EQ(header.camera.pinhole.cy, 2.5);
  EXPECT_EQ(header.camera.distortion.k1, 0.1);
  EXPECT_EQ(header.camera.distortion.k2, -0.2);
  EXPECT_EQ(header.camera.distortion.p1, 0.01);
  EXPECT_EQ(header.camera.distortion.p2, -0.02);
  EXPECT_EQ(header.camera.distortion.k3, 0.05);
  EXPECT_EQ(header.unit, 1e-3);
  EXPECT_EQ(header.stamp, 1234.5);
  ASSERT_TRUE(header.T_world_sensor);
  EXPECT_EQ(header.T_world_sensor->translation(), Eigen::Vector3d(1, -2, 3));
  // A quarter turn about y takes the camera's z to the world's x.
  const Eigen::Vector3d ahead = header.T_world_sensor->linear().col(2);
  EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d::UnitX(), 1e-12)) << ahead.transpose();
}

// What the document's table says of the bytes.
TEST(RemoteFrame, HasEachFieldAtItsPlace) {
  const std::vector<std::byte> plain = RemoteFrame{}.bytes();
  const auto place_of = [&](auto change) {
    RemoteFrame other;
    change(other);
    const std::vector<std::byte> bytes = other.bytes();
    return std::ranges::mismatch(plain, bytes).in1 - plain.begin();
  };
  // All of whose bytes differ from those of the numbers that are there.
  const double odd = std::bit_cast<double>(0x0123456789abcdefULL);
  EXPECT_EQ(place_of([](RemoteFrame& f) { f.magic[0] = 'q'; }), 0);
  EXPECT_EQ(place_of([](RemoteFrame& f) { f.version = 2; }), 4);
  EXPECT_EQ(place_of([](RemoteFrame& f) { f.flags = 1; }), 6);
  EXPECT_EQ(place_of([](RemoteFrame& f) { f.width = 9; }), 8);
  EXPECT_EQ(place_of([](RemoteFrame& f) { f.height = 9; }), 12);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.unit = odd; }), 16);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.lens[0] = odd; }), 24);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.lens[2] = odd; }), 40);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.distortion[0] = odd; }), 56);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.stamp = odd; }), 96);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.pose[0] = odd; }), 104);
  EXPECT_EQ(place_of([=](RemoteFrame& f) { f.pose[3] = odd; }), 128);
  EXPECT_EQ(place_of([](RemoteFrame& f) { f.steps[0] = 1; }), 160);
  EXPECT_EQ(std::to_integer<char>(plain[3]), 'D');
  EXPECT_EQ(std::to_integer<int>(plain[8]), 8) << "the lowest byte comes first";
}

TEST(RemoteFrame, WithoutFlagsHasNeitherStampNorPose) {
  RemoteFrame sent;
  sent.stamp = kNan;
  sent.pose = {kNan, 0, 0, 0, 0, 0, 0};
  const FrameHeader header = header_of(sent);
  EXPECT_FALSE(header.stamp);
  EXPECT_FALSE(header.T_world_sensor);
}

TEST(RemoteFrame, DepthsAreStepsTimesTheUnit) {
  RemoteFrame sent;
  sent.unit = 2.5e-4;
  sent.steps[0] = 0;
  sent.steps[1] = 65535;
  sent.steps[2] = 65534;
  sent.steps[3] = 0x0102;
  const DepthFrame frame = only(sent);
  ASSERT_EQ(frame.depth.size(), 48u);
  EXPECT_EQ(frame.depth[0], 0.0F);
  EXPECT_EQ(frame.depth[1], 0.0F) << "too far to tell";
  EXPECT_EQ(frame.depth[2], static_cast<float>(2.5e-4 * 65534));
  EXPECT_EQ(frame.depth[3], static_cast<float>(2.5e-4 * 258));
  EXPECT_EQ(frame.depth[47], static_cast<float>(2.5e-4 * 700));
}

TEST(RemoteFrame, MetresInFloatsKeepTheirBits) {
  RemoteFrame sent;
  sent.flags = 4;
  sent.unit = 1;
  sent.steps.clear();
  for (int i = 0; i < 48; ++i) sent.floats.push_back(0.7F + 1.1e-6F * static_cast<float>(i));
  sent.floats[1] = std::numeric_limits<float>::quiet_NaN();
  sent.floats[2] = std::numeric_limits<float>::infinity();
  sent.floats[3] = -1;
  const DepthFrame frame = only(sent);
  ASSERT_EQ(frame.depth.size(), 48u);
  for (std::size_t i = 0; i < 48; ++i) {
    EXPECT_EQ(frame.depth[i], i >= 1 && i <= 3 ? 0.0F : sent.floats[i]) << i;
  }
  sent.unit = 1e-3;
  EXPECT_EQ(only(sent).depth[0], static_cast<float>(1e-3 * static_cast<double>(0.7F)));
}

TEST(RemoteFrame, ComeWholeHoweverTheBytesAreCut) {
  RemoteFrame first;
  RemoteFrame second;
  second.flags = 4;
  second.unit = 1;
  second.steps.clear();
  second.floats.assign(48, 0.3F);
  std::vector<std::byte> bytes = first.bytes();
  const std::vector<std::byte> more = second.bytes();
  bytes.insert(bytes.end(), more.begin(), more.end());
  for (const std::size_t piece : {1, 2, 3, 7, 159, 160, 161, 255, 256, 257, 10'000}) {
    const std::vector<DepthFrame> frames = frames_of(bytes, piece);
    ASSERT_EQ(frames.size(), 2u) << piece;
    EXPECT_EQ(frames[0].depth, std::vector<float>(48, static_cast<float>(1e-3 * 700)));
    EXPECT_EQ(frames[1].depth, std::vector<float>(48, 0.3F));
  }
  bytes.pop_back();
  EXPECT_EQ(frames_of(bytes, 7).size(), 1u) << "one byte is missing";
}

TEST(RemoteFrame, RefusesWhatIsNoHeaderAndNamesTheValue) {
  const auto with = [](auto change) {
    RemoteFrame sent;
    sent.flags = 3;
    change(sent);
    return complaint(sent);
  };
  EXPECT_EQ(with([](RemoteFrame&) {}), "");
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.magic[3] = 'S'; }), "0x53706c70"));
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.version = 7; }), "version is 7"));
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.flags = 8; }), "flags are 0x8"));
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.unit = 0; }), "unit is 0"));
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.unit = kNan; }), "unit is nan"));
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.unit = 1.5; }), "unit is 1.5"));
  const std::array names{"fx is ", "fy is ", "cx is ", "cy is "};
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double bad : {kNan, kInfinity, -kInfinity, 2e6, -2e6}) {
      EXPECT_TRUE(test::contains(with([&](RemoteFrame& f) { f.lens[i] = bad; }), names[i])) << bad;
    }
  }
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.lens[0] = 0; }), "fx is 0"));
  const std::array bends{"k1 is ", "k2 is ", "p1 is ", "p2 is ", "k3 is "};
  for (std::size_t i = 0; i < 5; ++i) {
    for (const double bad : {kNan, kInfinity, 1001.0}) {
      EXPECT_TRUE(test::contains(with([&](RemoteFrame& f) { f.distortion[i] = bad; }), bends[i]));
    }
  }
  for (const double bad : {kNan, kInfinity, 1.7e12}) {
    EXPECT_TRUE(test::contains(with([&](RemoteFrame& f) { f.stamp = bad; }), "the stamp is "));
  }
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_TRUE(test::contains(with([&](RemoteFrame& f) { f.pose[i] = kNan; }), "the pose is "));
  }
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.pose[0] = 2e6; }), "the pose is 2"));
  EXPECT_TRUE(test::contains(with([](RemoteFrame& f) { f.pose[6] = 0.9; }), "0.9; send"));
}

TEST(RemoteFrame, RefusesSizesThatNoCameraHasBeforeItTakesMemory) {
  struct Size {
    std::uint32_t width, height;
  };
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  for (const Size size : {Size{0, 6},
                          {6, 0},
                          {5, 6},
                          {6, 5},
                          {8193, 6},
                          {6, 8193},
                          {8192, 8192},
                          {4097, 4096},
                          {kMost, kMost},
                          {kMost, 6},
                          {1u << 31U, 2}}) {
    RemoteFrame sent;
    sent.width = size.width;
    sent.height = size.height;
    EXPECT_TRUE(test::contains(complaint(sent), "the size is " + std::to_string(size.width)));
    EXPECT_THROW((void)frames_of(sent.bytes(), 1000), Error);
  }
  for (const Size size : {Size{6, 6}, {8192, 2048}, {4096, 4096}}) {
    RemoteFrame sent;
    sent.width = size.width;
    sent.height = size.height;
    EXPECT_EQ(header_of(sent).pixel_bytes(), std::size_t{2} * size.width * size.height);
  }
}

}  // namespace
}  // namespace palpate::sensor
