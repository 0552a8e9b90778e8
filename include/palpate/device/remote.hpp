#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/remote_packet.hpp"

namespace palpate {

struct RemoteDeviceOptions {
  std::string path = {};          ///< of the socket; empty: default_remote_path()
  double maximum_force = 5;       ///< of the hardware, continuous, N; longer forces are shortened
  double maximum_stiffness = 0;   ///< N/m that its maker allows; 0: not known
  double workspace_radius = 0.1;  ///< m; only told, never enforced
  double rate = 1000;             ///< steps a second, Hz
  double silence = 0.1;           ///< s without a good packet after which the client is lost
  double fade = 0.05;             ///< s in which the largest force is gone then
  double soft_start = 0.5;        ///< s in which the largest force is there again
};

/// What came, since construction.
struct RemoteCounts {
  std::uint64_t received = 0;                         ///< datagrams
  std::uint64_t taken = 0;                            ///< that told something new
  std::uint64_t unsent = 0;                           ///< forces that the client did not take
  std::array<std::uint64_t, kPacketFlaws> refused{};  ///< by PacketFlaw
  PacketFlaw last = PacketFlaw::none;                 ///< of what was refused last

  [[nodiscard]] std::uint64_t refused_for(PacketFlaw flaw) const noexcept {
    return refused[static_cast<std::size_t>(flaw)];
  }
};

/// Any program as a device: it tells where the hand is and is told the force, in datagrams over a
/// UNIX socket that its user alone may open (docs/remote_device.md).
///
/// read() takes what has come, at most kMostPackets datagrams, and keeps the newest; write() sends.
/// Neither waits. What is not a good packet is counted, left out and never looked at further. The
/// first client has the device until it leaves or is silent.
///
/// Silence is no failure: the status is `silent`, the force goes to zero, and both sides see to it.
/// When a client is heard again, twice at least, its place is told as `silent` first, so that
/// whoever computes forces knows where the hand is before there is one; then the force that is let
/// through comes up from zero. `failed` and latched is a force that is not finite, and a socket
/// that breaks.
class RemoteDevice final : public Device {
 public:
  static constexpr int kMostPackets = 64;

  /// Opens the socket. `clock` outlives the device; DeviceState::time is its time.
  /// @throws Error when an option is out of range or the socket cannot be had.
  explicit RemoteDevice(const Clock& clock, const RemoteDeviceOptions& options = {});
  ~RemoteDevice() override;
  RemoteDevice(const RemoteDevice&) = delete;
  RemoteDevice& operator=(const RemoteDevice&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override;
  /// Also why the device is silent. Any thread.
  [[nodiscard]] std::string reason() const override;

  [[nodiscard]] const std::string& path() const noexcept;
  /// Any thread.
  [[nodiscard]] RemoteCounts counts() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// $XDG_RUNTIME_DIR/palpate-device.
/// @throws Error when there is no such variable.
[[nodiscard]] std::string default_remote_path();

}  // namespace palpate
