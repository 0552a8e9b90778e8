// Reads and writes the packets of the remote device's protocol.
#include <cmath>

#include "base/little_endian.hpp"
#include "device/remote_protocol.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kStateMagic = 0x53706C70;  // "plpS"
constexpr std::uint32_t kForceMagic = 0x46706C70;  // "plpF"

// Flags of states; the last three are of version 2.
constexpr unsigned kHasVelocity = 1;
constexpr unsigned kLeaving = 2;
constexpr unsigned kHasAngularVelocity = 4;
constexpr unsigned kRendersTorque = 8;
constexpr unsigned kRendersGrip = 16;
// Flags of forces.
constexpr unsigned kLive = 1;
constexpr unsigned kClosing = 2;

constexpr unsigned known_flags(std::uint16_t version) noexcept {
  const unsigned first = kHasVelocity | kLeaving;
  return version == RemoteVersion::kForces
             ? first
             : first | kHasAngularVelocity | kRendersTorque | kRendersGrip;
}

constexpr unsigned flag(unsigned bit, bool on) noexcept {
  return on ? bit : 0;
}

bool within(const Vector3d& value, double largest) noexcept {
  return value.cwiseAbs().maxCoeff() <= largest;
}

PacketFlaw judge(const StatePacket& packet) noexcept {
  const StatePacket::Turns& turns = packet.turns;
  const bool finite = std::isfinite(packet.stamp) && packet.position.allFinite() &&
                      packet.velocity.allFinite() && turns.orientation.coeffs().allFinite() &&
                      turns.velocity.allFinite() && std::isfinite(turns.opening);
  if (!finite) return PacketFlaw::number;
  const bool in_range = std::abs(packet.stamp) <= StatePacket::kLargestStamp &&
                        within(packet.position, StatePacket::kLargestPosition) &&
                        within(packet.velocity, StatePacket::kLargestVelocity) &&
                        within(turns.velocity, StatePacket::kLargestVelocity) &&
                        std::abs(turns.opening) <= StatePacket::kLargestPosition;
  if (!in_range) return PacketFlaw::range;
  const bool turned = std::abs(turns.orientation.norm() - 1) <= StatePacket::kNotUnit;
  return turned ? PacketFlaw::none : PacketFlaw::orientation;
}

StatePacket::Turns take_turns(LittleEndianReader& reader, unsigned flags) noexcept {
  StatePacket::Turns turns;
  turns.orientation.w() = reader.take_double();
  turns.orientation.vec() = reader.take_vector();
  turns.velocity = reader.take_vector();
  turns.opening = reader.take_double();
  turns.has_velocity = (flags & kHasAngularVelocity) != 0;
  turns.renders_torque = (flags & kRendersTorque) != 0;
  turns.renders_grip = (flags & kRendersGrip) != 0;
  if (!turns.has_velocity) turns.velocity.setZero();
  return turns;
}

}  // namespace

ParsedState parse_state(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != state_packet_size(RemoteVersion::kForces) && bytes.size() != kLargestPacket) {
    return {PacketFlaw::length, {}};
  }
  LittleEndianReader reader(bytes);
  if (reader.take<std::uint32_t>() != kStateMagic) return {PacketFlaw::magic, {}};
  StatePacket packet;
  packet.version = reader.take<std::uint16_t>();
  const bool known =
      packet.version == RemoteVersion::kForces || packet.version == RemoteVersion::kTurns;
  if (!known) return {PacketFlaw::version, {}};
  if (bytes.size() != state_packet_size(packet.version)) return {PacketFlaw::length, {}};
  const unsigned flags = reader.take<std::uint16_t>();
  packet.sequence = reader.take<std::uint64_t>();
  packet.stamp = reader.take_double();
  packet.position = reader.take_vector();
  packet.velocity = reader.take_vector();
  packet.buttons = reader.take<std::uint32_t>();
  const auto reserved = reader.take<std::uint32_t>();
  if ((flags & ~known_flags(packet.version)) != 0 || reserved != 0) return {PacketFlaw::flags, {}};
  packet.has_velocity = (flags & kHasVelocity) != 0;
  packet.leaving = (flags & kLeaving) != 0;
  if (!packet.has_velocity) packet.velocity.setZero();
  if (packet.version == RemoteVersion::kTurns) packet.turns = take_turns(reader, flags);
  const PacketFlaw flaw = judge(packet);
  if (flaw != PacketFlaw::none) return {flaw, {}};
  packet.turns.orientation.normalize();
  return {flaw, packet};
}

PacketBytes encode(const StatePacket& packet) noexcept {
  PacketBytes bytes;
  LittleEndianWriter writer(bytes.all);
  const StatePacket::Turns& turns = packet.turns;
  writer.put(kStateMagic);
  writer.put(packet.version);
  writer.put(static_cast<std::uint16_t>(
      flag(kHasVelocity, packet.has_velocity) | flag(kLeaving, packet.leaving) |
      flag(kHasAngularVelocity, turns.has_velocity) | flag(kRendersTorque, turns.renders_torque) |
      flag(kRendersGrip, turns.renders_grip)));
  writer.put(packet.sequence);
  writer.put(packet.stamp);
  writer.put(packet.position);
  writer.put(packet.velocity);
  writer.put(packet.buttons);
  if (packet.version == RemoteVersion::kTurns) {
    writer.put(std::uint32_t{0});
    writer.put(turns.orientation.w());
    writer.put(Vector3d(turns.orientation.vec()));
    writer.put(turns.velocity);
    writer.put(turns.opening);
  }
  bytes.size = state_packet_size(packet.version);
  return bytes;
}

PacketBytes encode(const ForcePacket& packet) noexcept {
  PacketBytes bytes;
  LittleEndianWriter writer(bytes.all);
  writer.put(kForceMagic);
  writer.put(packet.version);
  writer.put(static_cast<std::uint16_t>(flag(kLive, packet.live) | flag(kClosing, packet.closing)));
  writer.put(packet.sequence);
  writer.put(packet.answered);
  writer.put(packet.stamp);
  writer.put(packet.force);
  if (packet.version == RemoteVersion::kTurns) {
    writer.put(packet.torque);
    writer.put(packet.grip);
  }
  bytes.size = force_packet_size(packet.version);
  return bytes;
}

std::string_view explain(PacketFlaw flaw) noexcept {
  switch (flaw) {
    case PacketFlaw::none:
      return {};
    case PacketFlaw::length:
      return "it is not 80 bytes long (version 2: 144); send one state per datagram";
    case PacketFlaw::magic:
      return "it does not start with plpS; is the client meant for another program?";
    case PacketFlaw::version:
      return "its version is neither 1 nor 2; use a client for this version of palpate";
    case PacketFlaw::flags:
      return "it has flags unknown to its version, or nonzero reserved bytes; send zeros there";
    case PacketFlaw::number:
      return "it contains a number that is not finite; send nothing while the hand's position is "
             "unknown";
    case PacketFlaw::range:
      return "it contains a number that is too large; use metres and seconds";
    case PacketFlaw::orientation:
      return "its orientation does not have unit length; send w, x, y, z of a rotation";
    case PacketFlaw::order:
      return "its sequence number or timestamp did not increase; wait for the timeout before "
             "restarting";
    case PacketFlaw::mixed:
      return "its version is not that of the client's first packet; send one version";
    case PacketFlaw::other_client:
      return "the device is in use by another client; stop that one";
    case PacketFlaw::no_address:
      return "its socket has no return address; bind it";
  }
  return {};
}

}  // namespace palpate
