#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "device/datagram_socket.hpp"
#include "palpate/device/remote.hpp"

namespace palpate {

/// What a RemoteDevice makes of packets: whom it listens to, what it believes, how much force may
/// flow. No socket and no clock: times are given, s, and never go back. Real-time.
class RemoteLink {
 public:
  explicit RemoteLink(const RemoteDeviceOptions& options) noexcept : options_(options) {}

  /// A datagram that came from `from`. Returns what was wrong with it.
  PacketFlaw hear(std::span<const std::byte> bytes, const SocketAddress& from, double now) noexcept;

  /// The state after all that was heard until now; once a step.
  [[nodiscard]] DeviceState state(double now) noexcept;

  /// The packet that answers the last state with as much of `force` as may flow. None: there is
  /// nobody to answer to.
  [[nodiscard]] std::optional<ForcePacket> answer(const Eigen::Vector3d& force) noexcept;
  /// The packet that ends it all, if there is somebody to be told.
  [[nodiscard]] std::optional<ForcePacket> farewell() noexcept;
  [[nodiscard]] const SocketAddress& client() const noexcept { return client_; }

 private:
  [[nodiscard]] bool silent(double now) const noexcept;
  [[nodiscard]] bool is_news(const StatePacket& packet) const noexcept;
  void begin(const StatePacket& packet, const SocketAddress& from) noexcept;
  void take(const StatePacket& packet) noexcept;
  void move_limit(double now) noexcept;
  [[nodiscard]] ForcePacket next_packet() noexcept;

  RemoteDeviceOptions options_;
  SocketAddress client_;  // whom to answer to; kept a while after it fell silent
  StatePacket newest_;
  DeviceState state_{.status = DeviceStatus::silent};
  double heard_ = 0;            // when the newest packet came
  double now_ = 0;              // of the last state()
  double limit_ = 0;            // of the force, N
  bool listening_ = false;      // the client has said something and has not left
  bool confirmed_ = false;      // ... and it was no repetition of one packet
  bool placed_ = false;         // a step has told where its hand is
  bool told_zero_ = true;       // the client knows that there is no force any more
  std::uint64_t sequence_ = 0;  // of the last force packet
};

}  // namespace palpate
