#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace palpate {

/// Datagrams between a RemoteDevice and the program that stands for the hardware
/// (docs/remote_device.md): little-endian, of fixed sizes, version 1. All functions are pure and
/// real-time.
inline constexpr std::uint16_t kRemoteVersion = 1;
inline constexpr std::size_t kStatePacketSize = 80;  ///< bytes
inline constexpr std::size_t kForcePacketSize = 56;  ///< bytes

/// What a client tells.
struct StatePacket {
  std::uint64_t sequence = 0;                          ///< grows from packet to packet
  double stamp = 0;                                    ///< s, on the client's clock; grows too
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, device frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s; zero unless has_velocity
  std::uint32_t buttons = 0;                           ///< bit k: button k is down
  bool has_velocity = false;
  bool leaving = false;  ///< the client's last packet

  static constexpr double kLargestStamp = 1e10;     ///< s, either way
  static constexpr double kLargestPosition = 100;   ///< m along an axis
  static constexpr double kLargestVelocity = 1000;  ///< m/s along an axis
};

/// What a client is told.
struct ForcePacket {
  std::uint64_t sequence = 0;                       ///< grows from packet to packet
  std::uint64_t answered = 0;                       ///< sequence of the state that it answers
  double stamp = 0;                                 ///< of that state, s, on the client's clock
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, on the hand, device frame
  bool live = false;     ///< the client is heard; else the force is zero or fades
  bool closing = false;  ///< the last packet: zero force from now on
};

/// What is wrong with a datagram that should tell a hand's state.
enum class PacketFlaw : std::uint8_t {
  none,
  length,
  magic,
  version,
  flags,     ///< unknown flags, or reserved bytes that are not 0
  number,    ///< a number that is not finite
  range,     ///< a number that is too large
  order,     ///< sequence or stamp have not grown: repeated, or overtaken
  stranger,  ///< another client is being listened to
  nameless,  ///< its socket has no address, so nothing can be answered
};
inline constexpr std::size_t kPacketFlaws = 10;

struct ParsedState {
  PacketFlaw flaw = PacketFlaw::none;
  StatePacket packet;  ///< where there is no flaw; all of it finite and in range
};

/// Flaws up to `range`: the others are a matter of who and when.
[[nodiscard]] ParsedState parse_state(std::span<const std::byte> bytes) noexcept;

[[nodiscard]] std::array<std::byte, kStatePacketSize> encode(const StatePacket& packet) noexcept;
[[nodiscard]] std::array<std::byte, kForcePacketSize> encode(const ForcePacket& packet) noexcept;

/// What is wrong and what to do; empty for none.
[[nodiscard]] std::string_view in_words(PacketFlaw flaw) noexcept;

}  // namespace palpate
