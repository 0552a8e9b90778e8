#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/datagram_socket.hpp"
#include "palpate/device/remote.hpp"
#include "palpate/geometry/pose.hpp"

namespace palpate {

/// The protocol between a RemoteDevice and its client, the program that stands for the hardware
/// (docs/remote_device.md): datagrams of fixed sizes, little-endian. A client of version 1 has
/// three axes; those of version 2 tell turns and opening besides, and get torque and grip. All
/// functions are pure and real-time.
struct RemoteVersion {
  static constexpr std::uint16_t kForces = 1;
  static constexpr std::uint16_t kTurns = 2;
};
/// Bytes of a packet of that version.
[[nodiscard]] constexpr std::size_t state_packet_size(std::uint16_t version) noexcept {
  return version == RemoteVersion::kForces ? 80 : 144;
}
[[nodiscard]] constexpr std::size_t force_packet_size(std::uint16_t version) noexcept {
  return version == RemoteVersion::kForces ? 56 : 88;
}
inline constexpr std::size_t kLargestPacket = state_packet_size(RemoteVersion::kTurns);

/// The bytes of a packet.
struct PacketBytes {
  std::array<std::byte, kLargestPacket> all{};
  std::size_t size = 0;

  // NOLINTNEXTLINE(google-explicit-constructor): it is sent as what it is
  operator std::span<const std::byte>() const noexcept { return std::span(all).first(size); }
};

/// From the client: where the hand is.
struct StatePacket {
  /// What version 2 tells besides; the rest of a hand of version 1 is straight and closed.
  struct Turns {
    /// From the tool's axes to the device's; of unit length once it was parsed.
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< rad/s; zero unless has_velocity
    double opening = 0;                                  ///< of the gripper, m
    bool has_velocity = false;
    bool renders_torque = false;  ///< the client has motors for it
    bool renders_grip = false;
  };

  std::uint16_t version = RemoteVersion::kForces;
  std::uint64_t sequence = 0;                          ///< grows from packet to packet
  double stamp = 0;                                    ///< s, on the client's clock; grows too
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, device frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s; zero unless has_velocity
  std::uint32_t buttons = 0;                           ///< bit k: button k is down
  bool has_velocity = false;
  bool leaving = false;  ///< the client's last packet
  Turns turns = {};

  static constexpr double kLargestStamp = 1e10;     ///< s, of either sign
  static constexpr double kLargestPosition = 100;   ///< m along an axis
  static constexpr double kLargestVelocity = 1000;  ///< m/s along an axis, rad/s around one
  /// An orientation's length differs from 1 by no more: numbers of four digits are enough.
  static constexpr double kNotUnit = 1e-3;
};

/// Packet to the client: the force.
struct ForcePacket {
  std::uint64_t sequence = 0;                       ///< grows from packet to packet
  std::uint64_t answered = 0;                       ///< sequence of the state that it answers
  double stamp = 0;                                 ///< of that state, s, on the client's clock
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, on the hand, device frame
  bool live = false;     ///< packets from the client arrive; else the force is zero or fades
  bool closing = false;  ///< the last packet: zero force from now on
  std::uint16_t version = RemoteVersion::kForces;
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m; of version 2, as the next
  double grip = 0;                                   ///< N
};

/// Fault of a datagram that should be a StatePacket.
enum class PacketFlaw : std::uint8_t {
  none,
  length,
  magic,
  version,
  flags,         ///< unknown flags, or reserved bytes that are not 0
  number,        ///< a number that is not finite
  range,         ///< a number that is too large
  orientation,   ///< one that has not unit length
  order,         ///< sequence or stamp have not grown: repeated, or overtaken
  mixed,         ///< another version than the client began with
  other_client,  ///< the device belongs to another client
  no_address,    ///< the client's socket has no address to answer to
};
inline constexpr std::size_t kPacketFlaws = 12;

struct ParsedState {
  PacketFlaw flaw = PacketFlaw::none;
  StatePacket packet;  ///< where there is no flaw; all of it finite and in range
};

/// Finds flaws up to `orientation`: the others depend on who sent it, and when.
[[nodiscard]] ParsedState parse_state(std::span<const std::byte> bytes) noexcept;

[[nodiscard]] PacketBytes encode(const StatePacket& packet) noexcept;
[[nodiscard]] PacketBytes encode(const ForcePacket& packet) noexcept;

/// States what is wrong and what to do; empty for none.
[[nodiscard]] std::string_view explain(PacketFlaw flaw) noexcept;

/// A RemoteDevice's side of the protocol: which client it listens to, the state that it reports,
/// how much force it lets through. No socket and no clock: times are given, s, and never go back.
/// Real-time.
class RemoteProtocol {
 public:
  explicit RemoteProtocol(const RemoteDeviceOptions& options) noexcept : options_(options) {}

  /// Takes a datagram that came from `from`. Returns what was wrong with it.
  PacketFlaw receive(std::span<const std::byte> bytes, const SocketAddress& from,
                     double now) noexcept;

  /// The state after all that was received until now; once a step.
  [[nodiscard]] DeviceState state(double now) noexcept;

  /// The packet that answers the last state, in the client's version, with `wrench` limited to what
  /// is allowed now and to what the client renders. None: there is no client to answer.
  [[nodiscard]] std::optional<ForcePacket> answer(const Wrench& wrench) noexcept;
  /// The last packet, if there is a client to send it to.
  [[nodiscard]] std::optional<ForcePacket> farewell() noexcept;
  [[nodiscard]] const SocketAddress& client() const noexcept { return client_; }

 private:
  struct Received {
    StatePacket packet;
    double time = 0;  // when it came
  };

  [[nodiscard]] bool is_silent(double now) const noexcept;
  [[nodiscard]] bool is_newer(const StatePacket& packet) const noexcept;
  void begin(const StatePacket& packet, const SocketAddress& from, double now) noexcept;
  void take(const StatePacket& packet, double now) noexcept;
  void move_limit(double now) noexcept;
  void estimate_velocity() noexcept;
  [[nodiscard]] Wrench allowed(const Wrench& wrench) const noexcept;
  [[nodiscard]] ForcePacket next_packet() noexcept;

  RemoteDeviceOptions options_;
  SocketAddress client_;  // kept a while after it fell silent
  Received newest_;
  Received shown_;  // whose velocity was told last
  DeviceState state_{.status = DeviceState::Status::silent};
  double now_ = 0;              // of the last state()
  double limit_ = 0;            // of the force, N; torque and grip are limited to the same share
  bool connected_ = false;      // the client has sent something and has not left
  bool confirmed_ = false;      // ... more than one packet again and again
  bool located_ = false;        // a step has reported where its hand is
  bool sent_zero_ = true;       // the client has received that there is no force
  std::uint64_t sequence_ = 0;  // of the last force packet
};

}  // namespace palpate
