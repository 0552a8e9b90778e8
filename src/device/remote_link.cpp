#include "device/remote_link.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

// Between packets closer than this nothing can be told of a velocity; s.
constexpr double kShortest = 1e-4;

}  // namespace

bool RemoteLink::silent(double now) const noexcept {
  return !listening_ || now - heard_ > options_.silence;
}

bool RemoteLink::is_news(const StatePacket& packet) const noexcept {
  return packet.sequence > newest_.sequence && packet.stamp > newest_.stamp;
}

PacketFlaw RemoteLink::hear(std::span<const std::byte> bytes, const SocketAddress& from,
                            double now) noexcept {
  const auto [flaw, packet] = parse_state(bytes);
  if (flaw != PacketFlaw::none) return flaw;
  if (from.size == 0) return PacketFlaw::nameless;
  if (silent(now)) {
    if (packet.leaving) return PacketFlaw::none;
    begin(packet, from);
  } else {
    if (from != client_) return PacketFlaw::stranger;
    if (!is_news(packet)) return PacketFlaw::order;
    take(packet);
  }
  heard_ = now;
  state_.position = packet.position;
  state_.buttons = packet.buttons;
  return PacketFlaw::none;
}

// Nothing of what was known of the last client, and no force that was allowed to it, is the next
// one's.
void RemoteLink::begin(const StatePacket& packet, const SocketAddress& from) noexcept {
  client_ = from;
  newest_ = packet;
  state_.velocity = packet.velocity;
  state_.status = DeviceStatus::silent;
  limit_ = 0;
  listening_ = true;
  confirmed_ = false;
  placed_ = false;
}

void RemoteLink::take(const StatePacket& packet) noexcept {
  const double dt = packet.stamp - newest_.stamp;
  if (packet.has_velocity) {
    state_.velocity = packet.velocity;
  } else if (dt >= kShortest) {
    state_.velocity = (packet.position - newest_.position) / dt;
  }
  listening_ = !packet.leaving;
  confirmed_ = true;
  newest_ = packet;
}

// One packet makes nobody known: a program that hangs and repeats itself would be heard anew after
// each silence. And the place is told once before there may be a force.
DeviceState RemoteLink::state(double now) noexcept {
  move_limit(now);
  now_ = now;
  const bool lost = silent(now);
  state_.time = now;
  state_.status = !lost && confirmed_ && placed_ ? DeviceStatus::ok : DeviceStatus::silent;
  placed_ = !lost;
  if (lost) {
    state_.velocity.setZero();
    state_.buttons = 0;
  }
  return state_;
}

// Up only where the step before knew the hand.
void RemoteLink::move_limit(double now) noexcept {
  const double way = options_.maximum_force * (now - now_);
  if (silent(now)) {
    limit_ -= way / options_.fade;
  } else if (state_.status == DeviceStatus::ok) {
    limit_ += way / options_.soft_start;
  }
  limit_ = std::clamp(limit_, 0.0, options_.maximum_force);
}

ForcePacket RemoteLink::next_packet() noexcept {
  ForcePacket packet;
  packet.sequence = ++sequence_;
  packet.answered = newest_.sequence;
  packet.stamp = newest_.stamp;
  return packet;
}

std::optional<ForcePacket> RemoteLink::answer(const Vector3d& force) noexcept {
  const bool live = state_.status == DeviceStatus::ok;
  if (client_.size == 0 || (!live && told_zero_)) return std::nullopt;
  ForcePacket packet = next_packet();
  const double length = force.norm();
  packet.force = length > limit_ ? Vector3d(limit_ / length * force) : force;
  packet.live = live;
  told_zero_ = packet.force.isZero(0);
  return packet;
}

std::optional<ForcePacket> RemoteLink::farewell() noexcept {
  if (client_.size == 0) return std::nullopt;
  ForcePacket packet = next_packet();
  packet.closing = true;
  return packet;
}

}  // namespace palpate
