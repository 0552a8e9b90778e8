// Implements the packets and states of the remote device's protocol.
#include "device/remote_protocol.hpp"

#include <algorithm>
#include <cmath>

#include "base/little_endian.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kStateMagic = 0x53706C70;  // "plpS"
constexpr std::uint32_t kForceMagic = 0x46706C70;  // "plpF"

// Packets closer than this give no velocity, s.
constexpr double kShortest = 1e-4;

constexpr unsigned kHasVelocity = 1;
constexpr unsigned kLeaving = 2;
constexpr unsigned kLive = 1;
constexpr unsigned kClosing = 2;

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
  LittleEndianReader reader(bytes);
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
  LittleEndianWriter writer(bytes);
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
  LittleEndianWriter writer(bytes);
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

std::string_view explain(PacketFlaw flaw) noexcept {
  switch (flaw) {
    case PacketFlaw::none:
      return {};
    case PacketFlaw::length:
      return "it is not 80 bytes long; send one state per datagram";
    case PacketFlaw::magic:
      return "it does not start with plpS; is the client meant for another program?";
    case PacketFlaw::version:
      return "its version is not 1; use a client for this version of palpate";
    case PacketFlaw::flags:
      return "it has unknown flags or nonzero reserved bytes; send version 1";
    case PacketFlaw::number:
      return "it contains a number that is not finite; send nothing while the hand's position is "
             "unknown";
    case PacketFlaw::range:
      return "it contains a number that is too large; use metres and seconds";
    case PacketFlaw::order:
      return "its sequence number or timestamp did not increase; wait for the timeout before "
             "restarting";
    case PacketFlaw::other_client:
      return "the device is in use by another client; stop that one";
    case PacketFlaw::no_address:
      return "its socket has no return address; bind it";
  }
  return {};
}

bool RemoteProtocol::is_silent(double now) const noexcept {
  return !connected_ || now - received_ > options_.client_timeout;
}

bool RemoteProtocol::is_newer(const StatePacket& packet) const noexcept {
  return packet.sequence > newest_.sequence && packet.stamp > newest_.stamp;
}

PacketFlaw RemoteProtocol::receive(std::span<const std::byte> bytes, const SocketAddress& from,
                                   double now) noexcept {
  const auto [flaw, packet] = parse_state(bytes);
  if (flaw != PacketFlaw::none) return flaw;
  if (from.size == 0) return PacketFlaw::no_address;
  if (is_silent(now)) {
    if (packet.leaving) return PacketFlaw::none;
    begin(packet, from);
  } else {
    if (from != client_) return PacketFlaw::other_client;
    if (!is_newer(packet)) return PacketFlaw::order;
    take(packet);
  }
  received_ = now;
  state_.position = packet.position;
  state_.buttons = packet.buttons;
  return PacketFlaw::none;
}

// Begins with a client: keeps no state of the last one, and no force that was allowed for it.
void RemoteProtocol::begin(const StatePacket& packet, const SocketAddress& from) noexcept {
  client_ = from;
  newest_ = packet;
  state_.velocity = packet.velocity;
  state_.status = DeviceState::Status::silent;
  limit_ = 0;
  connected_ = true;
  confirmed_ = false;
  located_ = false;
}

void RemoteProtocol::take(const StatePacket& packet) noexcept {
  const double dt = packet.stamp - newest_.stamp;
  if (packet.has_velocity) {
    state_.velocity = packet.velocity;
  } else if (dt >= kShortest) {
    state_.velocity = (packet.position - newest_.position) / dt;
  }
  connected_ = !packet.leaving;
  confirmed_ = true;
  newest_ = packet;
}

// Requires two packets: a program that hangs and repeats one would count as a new client after each
// silence. And the position is reported once before there may be a force.
DeviceState RemoteProtocol::state(double now) noexcept {
  move_limit(now);
  now_ = now;
  const bool lost = is_silent(now);
  state_.time = now;
  state_.status =
      !lost && confirmed_ && located_ ? DeviceState::Status::ok : DeviceState::Status::silent;
  located_ = !lost;
  if (lost) {
    state_.velocity.setZero();
    state_.buttons = 0;
  }
  return state_;
}

// Moves the limit of forces, which grows only where the step before knew the hand.
void RemoteProtocol::move_limit(double now) noexcept {
  const double change = options_.maximum_force * (now - now_);
  if (is_silent(now)) {
    limit_ -= change / options_.fade;
  } else if (state_.status == DeviceState::Status::ok) {
    limit_ += change / options_.soft_start;
  }
  limit_ = std::clamp(limit_, 0.0, options_.maximum_force);
}

ForcePacket RemoteProtocol::next_packet() noexcept {
  ForcePacket packet;
  packet.sequence = ++sequence_;
  packet.answered = newest_.sequence;
  packet.stamp = newest_.stamp;
  return packet;
}

std::optional<ForcePacket> RemoteProtocol::answer(const Vector3d& force) noexcept {
  const bool live = state_.status == DeviceState::Status::ok;
  if (client_.size == 0 || (!live && sent_zero_)) return std::nullopt;
  ForcePacket packet = next_packet();
  const double length = force.norm();
  packet.force = length > limit_ ? Vector3d(limit_ / length * force) : force;
  packet.live = live;
  sent_zero_ = packet.force.isZero(0);
  return packet;
}

std::optional<ForcePacket> RemoteProtocol::farewell() noexcept {
  if (client_.size == 0) return std::nullopt;
  ForcePacket packet = next_packet();
  packet.closing = true;
  return packet;
}

}  // namespace palpate
