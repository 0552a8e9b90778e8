// Byte by byte against docs/viewer_protocol.md.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "viewer/bytes.hpp"
#include "viewer/messages.hpp"
#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {
namespace {

using Eigen::Vector3f;
using test::f32;
using test::i16;
using test::i8;
using test::u16;
using test::u32;
using test::u8;

void expect_vector(const std::string& bytes, std::size_t offset, const Vector3f& expected) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(f32(bytes, offset + 4 * static_cast<std::size_t>(i)), expected[i]) << "at " << offset;
  }
}

TEST(StateMessage, LiesByteByByteAsTheProtocolSays) {
  StateMessage message;
  message.device = 3;
  message.flags = state_flag::kTouching | state_flag::kFault | state_flag::kThinned;
  message.time = 1234.5678;
  message.hip = {1, 2, 3};
  message.proxy = {4, 5, 6};
  message.normal = {0, 0, 1};
  message.force = {-1, 0.5F, 2};
  message.radius = 0.01F;
  message.rate = 1000;
  message.computing = {1e-5F, 2e-5F};
  message.lateness = {3e-6F, 4e-6F};
  message.interval = 1e-3F;
  message.forces = {{1, 2, 3}, {4, 5, 6}};
  const std::string bytes = encode(message);
  ASSERT_EQ(bytes.size(), 92u + 2 * 12);
  EXPECT_EQ(u8(bytes, 0), 1);
  EXPECT_EQ(u8(bytes, 1), 3);
  EXPECT_EQ(u16(bytes, 2), 2);
  EXPECT_EQ(u32(bytes, 4), 1u + 64 + 128);
  EXPECT_EQ(test::number_at<double>(bytes, 8), 1234.5678);
  expect_vector(bytes, 16, message.hip);
  expect_vector(bytes, 28, message.proxy);
  expect_vector(bytes, 40, message.normal);
  expect_vector(bytes, 52, message.force);
  EXPECT_EQ(f32(bytes, 64), 0.01F);
  EXPECT_EQ(f32(bytes, 68), 1000.F);
  EXPECT_EQ(f32(bytes, 72), 1e-5F);
  EXPECT_EQ(f32(bytes, 76), 2e-5F);
  EXPECT_EQ(f32(bytes, 80), 3e-6F);
  EXPECT_EQ(f32(bytes, 84), 4e-6F);
  EXPECT_EQ(f32(bytes, 88), 1e-3F);
  expect_vector(bytes, 92, {1, 2, 3});
  expect_vector(bytes, 104, {4, 5, 6});
}

TEST(StateMessage, EndsWithTheToolThatTurns) {
  StateMessage message;
  message.flags = state_flag::kTool;
  message.forces = {{1, 2, 3}};
  message.orientation = Eigen::Quaternionf(0.8F, 0, 0.6F, 0);
  message.tool.orientation = Eigen::Quaternionf(0.5F, -0.5F, 0.5F, 0.5F);
  message.tool.opening = 0.25F;
  message.tool.hand_opening = 0.5F;
  message.tool.torque = {1, 2, 3};
  message.tool.grip = -4;
  const std::string bytes = encode(message);
  ASSERT_EQ(bytes.size(), 92u + 12 + 16 + 40);
  EXPECT_EQ(u32(bytes, 4), 65536u + 8192);
  EXPECT_EQ(f32(bytes, 108), 0.6F);
  expect_vector(bytes, 120, {-0.5F, 0.5F, 0.5F});
  EXPECT_EQ(f32(bytes, 132), 0.5F);
  EXPECT_EQ(f32(bytes, 136), 0.25F);
  EXPECT_EQ(f32(bytes, 140), 0.5F);
  expect_vector(bytes, 144, {1, 2, 3});
  EXPECT_EQ(f32(bytes, 156), -4.F);
}

TEST(ToolMessage, LiesByteByByteAsTheProtocolSays) {
  const std::string points =
      encode_tool(2, Tool({{{1, 2, 3}, 0.5, 1}, {{4, 5, 6}, 0, -1}}, Eigen::Vector3d::UnitY()));
  ASSERT_EQ(points.size(), 24u + 2 * 20);
  EXPECT_EQ(u8(points, 0), 5);
  EXPECT_EQ(u8(points, 1), 2);
  EXPECT_EQ(u32(points, 4), 2u);
  EXPECT_EQ(u32(points, 8), 0u);
  expect_vector(points, 12, {0, 1, 0});
  expect_vector(points, 24, {4, 5, 6});  // samples are in the order of sides
  EXPECT_EQ(f32(points, 40), -1.F);
  expect_vector(points, 44, {1, 2, 3});
  EXPECT_EQ(f32(points, 56), 0.5F);
  EXPECT_EQ(f32(points, 60), 1.F);

  const std::vector<Eigen::Vector3d> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Tool::Triangle> triangles{{0, 1, 2}};
  const Tool mesh = Tool::mesh(vertices, triangles, 2);
  const std::string bytes = encode_tool(0, mesh);
  ASSERT_EQ(u32(bytes, 8), 1u);
  const std::size_t faces = 24 + 20 * mesh.samples().size();
  ASSERT_EQ(bytes.size(), faces + 36);
  expect_vector(bytes, faces + 12, {1, 0, 0});
  expect_vector(bytes, faces + 24, {0, 1, 0});
}

TEST(StateMessage, OrientationFollowsTheForcesWhereItIsKnown) {
  StateMessage message;
  message.flags = state_flag::kClutched;
  message.forces = {{1, 2, 3}};
  EXPECT_EQ(u32(encode(message), 4), 4096u);
  message.orientation = Eigen::Quaternionf(0.5F, -0.5F, 0.25F, 0.75F);
  const std::string bytes = encode(message);
  ASSERT_EQ(bytes.size(), 92u + 12 + 16);
  EXPECT_EQ(u32(bytes, 4), 4096u + 8192);
  expect_vector(bytes, 104, {-0.5F, 0.25F, 0.75F});
  EXPECT_EQ(f32(bytes, 116), 0.5F);
}

TEST(CloudMessage, LiesByteByByteAsTheProtocolSays) {
  CloudMessage message;
  message.source = 2;
  message.stamp = 7.25;
  message.positions = {{1, 10, 5}, {3, 10, 9}};
  message.colors = {{10, 20, 30}, {40, 50, 60}};
  message.normals = {{0, 0, 1}, {1, 0, 0}};
  message.trust = {7, 255};
  message.radii = {1, 0.25F};
  message.faded = true;
  const std::string bytes = encode(message);
  ASSERT_EQ(bytes.size(), 40u + 2 * (6 + 3 + 2 + 1 + 1));
  EXPECT_EQ(u8(bytes, 0), 2);
  EXPECT_EQ(u8(bytes, 1), 2);
  EXPECT_EQ(u16(bytes, 2), 31);
  EXPECT_EQ(u32(bytes, 4), 2u);
  EXPECT_EQ(test::number_at<double>(bytes, 8), 7.25);
  expect_vector(bytes, 16, {1, 10, 5});
  expect_vector(bytes, 28, {2, 0, 4});
  const std::array<std::uint16_t, 6> positions{0, 0, 0, 65535, 0, 65535};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(u16(bytes, 40 + 2 * i), positions[i]);
  const std::array<std::uint8_t, 6> colors{10, 20, 30, 40, 50, 60};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(u8(bytes, 52 + i), colors[i]);
  const std::array<std::int8_t, 4> normals{0, 0, 127, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(i8(bytes, 58 + i), normals[i]);
  EXPECT_EQ(u8(bytes, 62), 7);
  EXPECT_EQ(u8(bytes, 63), 255);
  EXPECT_EQ(u8(bytes, 64), 160);
  EXPECT_EQ(u8(bytes, 65), 144);
}

TEST(CloudMessage, ARadiusIsAByteToATwentiethFromAMicrometreToKilometres) {
  for (float radius = 1e-6F; radius < 3500; radius *= 1.013F) {
    const float read = std::exp2((logarithmic(radius) - 160) / 8.F);
    EXPECT_NEAR(read / radius, 1, 0.05) << radius;
  }
  EXPECT_EQ(logarithmic(1e-9F), 0);
  EXPECT_EQ(logarithmic(1e9F), 255);
  EXPECT_EQ(logarithmic(std::numeric_limits<float>::infinity()), 255);
  for (const float none : {0.F, -1.F, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(logarithmic(none), 0);
  }
}

TEST(CloudMessage, OfNoPointsIsAHeaderOfFiniteNumbers) {
  const std::string bytes = encode(CloudMessage{});
  ASSERT_EQ(bytes.size(), 40u);
  EXPECT_EQ(u32(bytes, 4), 0u);
  expect_vector(bytes, 16, Vector3f::Zero());
  expect_vector(bytes, 28, Vector3f::Zero());
}

TEST(CloudMessage, PlacesComeBackToHalfAStepOfTheExtent) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> at(-3, 5);
  CloudMessage message;
  for (int i = 0; i < 1000; ++i)
    message.positions.emplace_back(at(random), at(random), 0.1F * at(random));
  const std::string bytes = encode(message);
  for (std::size_t p = 0; p < message.positions.size(); ++p) {
    for (std::size_t i = 0; i < 3; ++i) {
      const float extent = f32(bytes, 28 + 4 * i);
      const float place = f32(bytes, 16 + 4 * i) + extent * u16(bytes, 40 + 6 * p + 2 * i) / 65535;
      EXPECT_NEAR(place, message.positions[p][static_cast<Eigen::Index>(i)],
                  0.51F * extent / 65535);
    }
  }
}

TEST(SurfaceMessage, LiesByteByByteAsTheProtocolSays) {
  const Mesh mesh{{{0.5F, 0, 0}, {0, -0.25F, 0}, {0, 0, 0.5F}}, {{0, 1, 2}, {2, 1, 0}}};
  const std::string bytes = encode_surface(4, {1, 2, 3}, mesh);
  ASSERT_EQ(bytes.size(), 24u + 3 * 6 + 2 * 6);
  EXPECT_EQ(u8(bytes, 0), 3);
  EXPECT_EQ(u8(bytes, 1), 4);
  EXPECT_EQ(u16(bytes, 2), 3);
  EXPECT_EQ(u32(bytes, 4), 2u);
  expect_vector(bytes, 8, {1, 2, 3});
  EXPECT_EQ(f32(bytes, 20), 0.5F);
  const std::array<std::int16_t, 9> vertices{32767, 0, 0, 0, -16384, 0, 0, 0, 32767};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(i16(bytes, 24 + 2 * i), vertices[i], 1);
  const std::array<std::uint16_t, 6> triangles{0, 1, 2, 2, 1, 0};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(u16(bytes, 42 + 2 * i), triangles[i]);
}

TEST(SurfaceMessage, OfNothingIsAHeader) {
  const std::string bytes = encode_surface(0, Vector3f::Zero(), {});
  ASSERT_EQ(bytes.size(), 24u);
  EXPECT_EQ(u16(bytes, 2), 0);
  EXPECT_EQ(u32(bytes, 4), 0u);
}

// What the page does (docs/viewer_protocol.md, backwards).
Vector3f decoded(const std::array<std::int8_t, 2>& bytes) {
  const float x = bytes[0] / 127.F;
  const float y = bytes[1] / 127.F;
  const float z = 1 - std::abs(x) - std::abs(y);
  Vector3f n(x, y, z);
  if (z < 0) {
    n.x() = std::copysign(1 - std::abs(y), x);
    n.y() = std::copysign(1 - std::abs(x), y);
  }
  return n.normalized();
}

TEST(Octahedral, ADirectionComesBackToAboutADegree) {
  std::mt19937 random(2);
  std::normal_distribution<float> component;
  for (int i = 0; i < 10000; ++i) {
    const Vector3f n =
        Vector3f(component(random), component(random), component(random)).normalized();
    EXPECT_GT(decoded(octahedral(n)).dot(n), std::cos(0.02F)) << n.transpose();
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.F, 1.F}) {
      const Vector3f n = sign * Vector3f::Unit(axis);
      EXPECT_GT(decoded(octahedral(n)).dot(n), 0.9999F) << n.transpose();
    }
  }
}

TEST(Octahedral, WhatHasNoDirectionPointsUp) {
  const std::array<std::int8_t, 2> up{0, 0};
  EXPECT_EQ(octahedral(Vector3f::Zero()), up);
  EXPECT_EQ(octahedral(Vector3f::Constant(NAN)), up);
  EXPECT_EQ(octahedral(Vector3f::Constant(INFINITY)), up);
}

}  // namespace
}  // namespace palpate::viewer
