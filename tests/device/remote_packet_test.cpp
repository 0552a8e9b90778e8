#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "device/remote_protocol.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

StatePacket example() {
  StatePacket packet;
  packet.sequence = 0x0102030405060708;
  packet.stamp = -2;
  packet.position = {0.5, -0.25, 100};
  packet.velocity = {1, 2, -1000};
  packet.buttons = 0xA1B2C3D4;
  packet.has_velocity = true;
  return packet;
}

StatePacket turned_example() {
  StatePacket packet = example();
  packet.version = RemoteVersion::kTurns;
  packet.turns.orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  packet.turns.velocity = {3, 4, -1000};
  packet.turns.opening = 0.02;
  packet.turns.has_velocity = packet.turns.renders_torque = packet.turns.renders_grip = true;
  return packet;
}

std::vector<std::byte> bytes_of(const StatePacket& packet) {
  const PacketBytes encoded = encode(packet);
  const std::span<const std::byte> bytes = encoded;
  return {bytes.begin(), bytes.end()};
}

std::uint8_t at(std::span<const std::byte> bytes, std::size_t offset) {
  return std::to_integer<std::uint8_t>(bytes[offset]);
}

std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint64_t value = 0;
  for (std::size_t i = 8; i-- > 0;) value = value << 8 | at(bytes, offset + i);
  return value;
}

TEST(RemotePacket, StateLiesAsTheSpecificationSays) {
  const auto bytes = bytes_of(example());
  ASSERT_EQ(bytes.size(), 80u);
  EXPECT_EQ(at(bytes, 0), 'p');
  EXPECT_EQ(at(bytes, 1), 'l');
  EXPECT_EQ(at(bytes, 2), 'p');
  EXPECT_EQ(at(bytes, 3), 'S');
  EXPECT_EQ(at(bytes, 4), 1);
  EXPECT_EQ(at(bytes, 5), 0);
  EXPECT_EQ(at(bytes, 6), 1);
  EXPECT_EQ(number_at(bytes, 8), 0x0102030405060708u);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 16)), -2);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 24)), 0.5);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 40)), 100);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 48)), 1);
  EXPECT_EQ(number_at(bytes, 72), 0xA1B2C3D4u);
}

TEST(RemotePacket, StateThatTurnsLiesAsTheSpecificationSays) {
  const auto bytes = bytes_of(turned_example());
  ASSERT_EQ(bytes.size(), 144u);
  EXPECT_EQ(at(bytes, 4), 2);
  EXPECT_EQ(at(bytes, 6), 1 + 4 + 8 + 16);
  EXPECT_EQ(number_at(bytes, 72), 0xA1B2C3D4u);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 80)), 0.5);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 88)), -0.5);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 104)), 0.5);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 112)), 3);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 128)), -1000);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 136)), 0.02);
}

TEST(RemotePacket, WrenchLiesAsTheSpecificationSays) {
  ForcePacket packet{7, 9, 1.5, {1, -2, 4}, true, false};
  packet.version = RemoteVersion::kTurns;
  packet.torque = {0.25, 0, -0.5};
  packet.grip = -3;
  const PacketBytes encoded = encode(packet);
  const std::span<const std::byte> bytes = encoded;
  ASSERT_EQ(bytes.size(), 88u);
  EXPECT_EQ(at(bytes, 4), 2);
  EXPECT_EQ(at(bytes, 6), 1);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 48)), 4);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 56)), 0.25);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 72)), -0.5);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 80)), -3);
}

TEST(RemotePacket, ForceLiesAsTheSpecificationSays) {
  const PacketBytes encoded = encode(ForcePacket{7, 9, 1.5, {1, -2, 4}, true, true});
  const std::span<const std::byte> bytes = encoded;
  ASSERT_EQ(bytes.size(), 56u);
  EXPECT_EQ(at(bytes, 3), 'F');
  EXPECT_EQ(at(bytes, 4), 1);
  EXPECT_EQ(at(bytes, 6), 3);
  EXPECT_EQ(number_at(bytes, 8), 7u);
  EXPECT_EQ(number_at(bytes, 16), 9u);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 24)), 1.5);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 32)), 1);
  EXPECT_EQ(std::bit_cast<double>(number_at(bytes, 48)), 4);
}

TEST(RemotePacket, StateSurvivesTheWay) {
  const StatePacket sent = example();
  const auto [flaw, got] = parse_state(encode(sent));
  ASSERT_EQ(flaw, PacketFlaw::none);
  EXPECT_EQ(got.sequence, sent.sequence);
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.position, sent.position);
  EXPECT_EQ(got.velocity, sent.velocity);
  EXPECT_EQ(got.buttons, sent.buttons);
  EXPECT_TRUE(got.has_velocity);
  EXPECT_FALSE(got.leaving);
  EXPECT_TRUE(got.turns.orientation.isApprox(Eigen::Quaterniond::Identity(), 0));
}

TEST(RemotePacket, StateThatTurnsSurvivesTheWay) {
  const StatePacket sent = turned_example();
  const auto [flaw, got] = parse_state(encode(sent));
  ASSERT_EQ(flaw, PacketFlaw::none);
  EXPECT_EQ(got.version, RemoteVersion::kTurns);
  EXPECT_EQ(got.turns.orientation.coeffs(), sent.turns.orientation.coeffs());
  EXPECT_EQ(got.turns.velocity, sent.turns.velocity);
  EXPECT_EQ(got.turns.opening, sent.turns.opening);
  EXPECT_TRUE(got.turns.renders_torque);
  EXPECT_TRUE(got.turns.renders_grip);
}

TEST(RemotePacket, OrientationIsTakenForARotationOrRefused) {
  StatePacket packet = turned_example();
  packet.turns.orientation.coeffs() *= 1.0009;
  EXPECT_NEAR(parse_state(encode(packet)).packet.turns.orientation.norm(), 1, 1e-15);
  for (const double length : {0.0, 0.99, 1.002}) {
    packet.turns.orientation.coeffs() = length * Eigen::Vector4d::UnitX();
    EXPECT_EQ(parse_state(encode(packet)).flaw, PacketFlaw::orientation) << length;
  }
  packet.turns.orientation.x() = std::nan("");
  EXPECT_EQ(parse_state(encode(packet)).flaw, PacketFlaw::number);
}

TEST(RemotePacket, VelocityWithoutItsFlagIsNotLookedAt) {
  StatePacket packet = example();
  packet.has_velocity = false;
  packet.velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto [flaw, got] = parse_state(encode(packet));
  EXPECT_EQ(flaw, PacketFlaw::none);
  EXPECT_EQ(got.velocity, Vector3d::Zero());
}

TEST(RemotePacket, RefusesEveryOtherLength) {
  for (const StatePacket& packet : {example(), turned_example()}) {
    std::vector<std::byte> bytes = bytes_of(packet);
    const std::size_t good = bytes.size();
    bytes.resize(200);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const PacketFlaw flaw = parse_state(std::span(bytes).first(size)).flaw;
      EXPECT_EQ(flaw, size == good ? PacketFlaw::none : PacketFlaw::length) << size;
    }
  }
}

PacketFlaw flaw_with(std::size_t offset, std::uint8_t value) {
  auto bytes = bytes_of(example());
  bytes[offset] = static_cast<std::byte>(value);
  return parse_state(bytes).flaw;
}

TEST(RemotePacket, RefusesOtherMagicVersionsFlagsAndReservedBytes) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(flaw_with(i, 'F'), PacketFlaw::magic);
  EXPECT_EQ(flaw_with(4, 2), PacketFlaw::length) << "it would be longer";
  EXPECT_EQ(flaw_with(4, 0), PacketFlaw::version);
  EXPECT_EQ(flaw_with(4, 3), PacketFlaw::version);
  EXPECT_EQ(flaw_with(5, 1), PacketFlaw::version);
  EXPECT_EQ(flaw_with(6, 4), PacketFlaw::flags);
  EXPECT_EQ(flaw_with(7, 1), PacketFlaw::flags);
  for (std::size_t i = 76; i < 80; ++i) EXPECT_EQ(flaw_with(i, 1), PacketFlaw::flags);
}

template <class Change>
PacketFlaw flaw_of(const Change& change) {
  StatePacket packet = example();
  change(packet);
  return parse_state(encode(packet)).flaw;
}

TEST(RemotePacket, RefusesNumbersThatAreNotFiniteOrTooLarge) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(flaw_of([bad](StatePacket& p) { p.stamp = bad; }), PacketFlaw::number);
    EXPECT_EQ(flaw_of([bad](StatePacket& p) { p.position.y() = -bad; }), PacketFlaw::number);
    EXPECT_EQ(flaw_of([bad](StatePacket& p) { p.velocity.z() = bad; }), PacketFlaw::number);
  }
  EXPECT_EQ(flaw_of([](StatePacket& p) { p.stamp = 1.1e10; }), PacketFlaw::range);
  EXPECT_EQ(flaw_of([](StatePacket& p) { p.position.x() = -100.1; }), PacketFlaw::range);
  EXPECT_EQ(flaw_of([](StatePacket& p) { p.velocity.x() = 1e4; }), PacketFlaw::range);
  const auto turn = [](StatePacket& p) { p = turned_example(); };
  for (const double bad : {std::nan(""), 2000.0}) {
    const PacketFlaw flaw = bad > 0 ? PacketFlaw::range : PacketFlaw::number;
    EXPECT_EQ(flaw_of([&](StatePacket& p) { turn(p), p.turns.velocity.y() = bad; }), flaw);
    EXPECT_EQ(flaw_of([&](StatePacket& p) { turn(p), p.turns.opening = bad; }), flaw);
  }
}

TEST(RemotePacket, WhateverIsAcceptedIsFiniteAndInRange) {
  std::mt19937_64 random(1);
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    auto bytes = bytes_of(i % 2 == 0 ? example() : turned_example());
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < changes; ++k) bytes[random() % bytes.size()] = std::byte(random() & 0xFF);
    const auto [flaw, packet] = parse_state(bytes);
    if (flaw != PacketFlaw::none) continue;
    ++accepted;
    ASSERT_LE(std::abs(packet.stamp), StatePacket::kLargestStamp);
    ASSERT_LE(packet.position.cwiseAbs().maxCoeff(), StatePacket::kLargestPosition);
    ASSERT_LE(packet.velocity.cwiseAbs().maxCoeff(), StatePacket::kLargestVelocity);
    ASSERT_NEAR(packet.turns.orientation.norm(), 1, 1e-9);
    ASSERT_LE(packet.turns.velocity.cwiseAbs().maxCoeff(), StatePacket::kLargestVelocity);
  }
  EXPECT_GT(accepted, 100);
}

TEST(RemotePacket, EveryFlawHasWords) {
  EXPECT_EQ(explain(PacketFlaw::none), "");
  for (std::size_t i = 1; i < kPacketFlaws; ++i) {
    EXPECT_NE(explain(static_cast<PacketFlaw>(i)), "") << i;
  }
}

}  // namespace
}  // namespace palpate
