#include "palpate/device/remote_packet.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kStateMagic = 0x53706C70;  // "plpS"
constexpr std::uint32_t kForceMagic = 0x46706C70;  // "plpF"

constexpr unsigned kHasVelocity = 1;
constexpr unsigned kLeaving = 2;
constexpr unsigned kLive = 1;
constexpr unsigned kClosing = 2;

// Numbers one after the other, lowest byte first, whatever the processor's order.
class Writer {
 public:
  explicit Writer(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  void put(T value) noexcept {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_[at_++] = static_cast<std::byte>(value >> (8 * i) & 0xFF);
    }
  }
  void put(double value) noexcept { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const Vector3d& value) noexcept {
    for (const double x : value) put(x);
  }

 private:
  std::span<std::byte> bytes_;
  std::size_t at_ = 0;
};

class PacketReader {
 public:
  explicit PacketReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  template <class T>
  T take() noexcept {
    T value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i) {
      value = static_cast<T>(value | static_cast<T>(static_cast<T>(bytes_[at_++]) << (8 * i)));
    }
    return value;
  }
  double take_double() noexcept { return std::bit_cast<double>(take<std::uint64_t>()); }
  Vector3d take_vector() noexcept {
    Vector3d value;
    for (double& x : value) x = take_double();
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

bool within(const Vector3d& value, double largest) noexcept {
  return value.cwiseAbs().maxCoeff() <= largest;
}

PacketFlaw judge(const StatePacket& packet) noexcept {
  const bool finite =
      std::isfinite(packet.stamp) && packet.position.allFinite() && packet.velocity.allFinite();
  if (!finite) return PacketFlaw::number;
  const bool in_range = std::abs(packet.stamp) <= StatePacket::kLargestStamp &&
                        within(packet.position, StatePacket::kLargestPosition) &&
                        within(packet.velocity, StatePacket::kLargestVelocity);
  return in_range ? PacketFlaw::none : PacketFlaw::range;
}

}  // namespace

ParsedState parse_state(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kStatePacketSize) return {PacketFlaw::length, {}};
  PacketReader reader(bytes);
  if (reader.take<std::uint32_t>() != kStateMagic) return {PacketFlaw::magic, {}};
  if (reader.take<std::uint16_t>() != kRemoteVersion) return {PacketFlaw::version, {}};
  const unsigned flags = reader.take<std::uint16_t>();
  StatePacket packet;
  packet.sequence = reader.take<std::uint64_t>();
  packet.stamp = reader.take_double();
  packet.position = reader.take_vector();
  packet.velocity = reader.take_vector();
  packet.buttons = reader.take<std::uint32_t>();
  const auto reserved = reader.take<std::uint32_t>();
  if ((flags & ~(kHasVelocity | kLeaving)) != 0 || reserved != 0) return {PacketFlaw::flags, {}};
  packet.has_velocity = (flags & kHasVelocity) != 0;
  packet.leaving = (flags & kLeaving) != 0;
  if (!packet.has_velocity) packet.velocity.setZero();
  const PacketFlaw flaw = judge(packet);
  return flaw == PacketFlaw::none ? ParsedState{flaw, packet} : ParsedState{flaw, {}};
}

std::array<std::byte, kStatePacketSize> encode(const StatePacket& packet) noexcept {
  std::array<std::byte, kStatePacketSize> bytes{};
  Writer writer(bytes);
  writer.put(kStateMagic);
  writer.put(kRemoteVersion);
  writer.put(static_cast<std::uint16_t>((packet.has_velocity ? kHasVelocity : 0) |
                                        (packet.leaving ? kLeaving : 0)));
  writer.put(packet.sequence);
  writer.put(packet.stamp);
  writer.put(packet.position);
  writer.put(packet.velocity);
  writer.put(packet.buttons);
  return bytes;
}

std::array<std::byte, kForcePacketSize> encode(const ForcePacket& packet) noexcept {
  std::array<std::byte, kForcePacketSize> bytes{};
  Writer writer(bytes);
  writer.put(kForceMagic);
  writer.put(kRemoteVersion);
  writer.put(
      static_cast<std::uint16_t>((packet.live ? kLive : 0) | (packet.closing ? kClosing : 0)));
  writer.put(packet.sequence);
  writer.put(packet.answered);
  writer.put(packet.stamp);
  writer.put(packet.force);
  return bytes;
}

std::string_view in_words(PacketFlaw flaw) noexcept {
  switch (flaw) {
    case PacketFlaw::none:
      return {};
    case PacketFlaw::length:
      return "it has not 80 bytes; send one state a datagram";
    case PacketFlaw::magic:
      return "it does not begin with plpS; is that client meant for something else?";
    case PacketFlaw::version:
      return "it is not of version 1; use a client for this palpate";
    case PacketFlaw::flags:
      return "it has flags that version 1 does not know, or reserved bytes that are not 0";
    case PacketFlaw::number:
      return "a number in it is not finite; send nothing where the hand is not known";
    case PacketFlaw::range:
      return "a number in it is too large; lengths are metres, times seconds";
    case PacketFlaw::order:
      return "its sequence or its stamp has not grown; wait out the silence before starting anew";
    case PacketFlaw::stranger:
      return "another client is being listened to; end it";
    case PacketFlaw::nameless:
      return "its socket has no address to answer to; bind it";
  }
  return {};
}

}  // namespace palpate
