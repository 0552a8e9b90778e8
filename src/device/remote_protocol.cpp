// Keeps the state of a remote device's client, and limits the force that it gets.
#include "device/remote_protocol.hpp"

#include <algorithm>

#include "geometry/turn.hpp"
#include "geometry/wrench.hpp"

namespace palpate {
namespace {

// Packets closer than this give no velocity, s.
constexpr double kShortest = 1e-4;

}  // namespace

bool RemoteProtocol::is_silent(double now) const noexcept {
  return !connected_ || now - newest_.time > options_.client_timeout;
}

bool RemoteProtocol::is_newer(const StatePacket& packet) const noexcept {
  return packet.sequence > newest_.packet.sequence && packet.stamp > newest_.packet.stamp;
}

PacketFlaw RemoteProtocol::receive(std::span<const std::byte> bytes, const SocketAddress& from,
                                   double now) noexcept {
  const auto [flaw, packet] = parse_state(bytes);
  if (flaw != PacketFlaw::none) return flaw;
  if (from.size == 0) return PacketFlaw::no_address;
  if (is_silent(now)) {
    if (packet.leaving) return PacketFlaw::none;
    begin(packet, from, now);
  } else {
    if (from != client_) return PacketFlaw::other_client;
    if (packet.version != newest_.packet.version) return PacketFlaw::mixed;
    if (!is_newer(packet)) return PacketFlaw::order;
    take(packet, now);
  }
  state_.time = now;
  state_.position = packet.position;
  state_.buttons = packet.buttons;
  state_.orientation = packet.turns.orientation;
  state_.gripper = packet.turns.opening;
  return PacketFlaw::none;
}

// Begins with a client: keeps no state of the last one, and no force that was allowed for it.
void RemoteProtocol::begin(const StatePacket& packet, const SocketAddress& from,
                           double now) noexcept {
  client_ = from;
  newest_ = shown_ = {packet, now};
  state_.velocity.setZero();
  state_.angular_velocity.setZero();
  state_.status = DeviceState::Status::silent;
  limit_ = 0;
  connected_ = true;
  confirmed_ = false;
  located_ = false;
}

void RemoteProtocol::take(const StatePacket& packet, double now) noexcept {
  connected_ = !packet.leaving;
  confirmed_ = true;
  newest_ = {packet, now};
}

// From positions, whatever a client tells: a velocity that they do not show would be felt. Neither
// the client's clock nor the times of arrival can make a hand faster alone.
void RemoteProtocol::estimate_velocity() noexcept {
  if (newest_.packet.sequence == shown_.packet.sequence) return;
  const double dt =
      std::max(newest_.packet.stamp - shown_.packet.stamp, newest_.time - shown_.time);
  if (dt < kShortest) return;
  state_.velocity = (newest_.packet.position - shown_.packet.position) / dt;
  state_.angular_velocity =
      turn_between(shown_.packet.turns.orientation, newest_.packet.turns.orientation) / dt;
  shown_ = newest_;
}

// Requires two packets: a program that hangs and repeats one would count as a new client after each
// silence. And the position is reported once before there may be a force.
DeviceState RemoteProtocol::state(double now) noexcept {
  move_limit(now);
  estimate_velocity();
  now_ = now;
  const bool lost = is_silent(now);
  state_.status =
      !lost && confirmed_ && located_ ? DeviceState::Status::ok : DeviceState::Status::silent;
  located_ = !lost;
  if (lost) {
    state_.velocity.setZero();
    state_.angular_velocity.setZero();
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
  packet.answered = newest_.packet.sequence;
  packet.stamp = newest_.packet.stamp;
  packet.version = newest_.packet.version;
  return packet;
}

Wrench RemoteProtocol::allowed(const Wrench& wrench) const noexcept {
  const double share = limit_ / options_.maximum_force;
  const StatePacket::Turns& turns = newest_.packet.turns;
  return shortened(wrench, limit_, turns.renders_torque ? share * options_.maximum_torque : 0,
                   turns.renders_grip ? share * options_.maximum_grip : 0);
}

std::optional<ForcePacket> RemoteProtocol::answer(const Wrench& wrench) noexcept {
  const bool live = state_.status == DeviceState::Status::ok;
  if (client_.size == 0 || (!live && sent_zero_)) return std::nullopt;
  ForcePacket packet = next_packet();
  const Wrench sent = allowed(wrench);
  packet.force = sent.force;
  packet.torque = sent.torque;
  packet.grip = sent.grip;
  packet.live = live;
  sent_zero_ = sent.force.isZero(0) && sent.torque.isZero(0) && sent.grip == 0;
  return packet;
}

std::optional<ForcePacket> RemoteProtocol::farewell() noexcept {
  if (client_.size == 0) return std::nullopt;
  ForcePacket packet = next_packet();
  packet.closing = true;
  return packet;
}

}  // namespace palpate
