// Declares the device whose hardware another program owns.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"

namespace palpate {

struct RemoteDeviceOptions {
  std::string path = {};         ///< of the socket; empty: default_remote_path()
  double maximum_force = 5;      ///< of the hardware, continuous, N; longer forces are shortened
  double maximum_stiffness = 0;  ///< N/m that its maker allows; 0: unknown
  double maximum_torque = 0;     ///< of the hardware, continuous, N m; 0: it renders none
  double maximum_grip = 0;       ///< the same of its gripper, N
  double angular_damping = 0;    ///< viscous, of its turns, N m s/rad; 0: unknown
  bool turns = false;            ///< clients tell orientation and opening (version 2)
  double damping = 0;            ///< viscous, of the hardware by itself, N s/m; 0: unknown
  double mass = 0;               ///< that the hand moves with it, kg; 0: unknown
  std::optional<double> delay = {};  ///< DeviceInfo::delay, s, the socket's included
  double workspace_radius = 0.1;     ///< m; only reported, never enforced
  double rate = 1000;                ///< steps a second, Hz
  double client_timeout = 0.1;       ///< s without a valid packet after which the client is lost
  double fade = 0.05;                ///< s in which the largest force then goes to zero
  double soft_start = 0.5;           ///< s in which the largest force comes back
};

/// What a profile says of the hardware; the rest as by default.
[[nodiscard]] RemoteDeviceOptions remote_options(const DeviceProfile& profile);

/// Any program as a device: it sends where the hand is and receives the force, in datagrams over a
/// UNIX socket that only its user may open (docs/remote_device.md).
///
/// read() takes what has come, at most kMostPackets datagrams, and keeps the newest; write() sends.
/// Neither blocks. Invalid packets are counted and ignored. The first client keeps the device until
/// it leaves or falls silent.
///
/// Silence is not a failure: the status is `silent`, and the force goes to zero on both sides. When
/// a client sends again, twice at least, the first position still has status `silent`, so that
/// what computes forces receives the hand's position before any acts; then the allowed force
/// grows from zero. A force that is not finite, or a socket that breaks, latches `failed`.
class RemoteDevice final : public Device {
 public:
  /// Packets since construction.
  struct Counts {
    std::uint64_t received = 0;  ///< datagrams
    std::uint64_t taken = 0;     ///< that were valid and new
    std::uint64_t unsent = 0;    ///< forces that the client did not take
  };

  static constexpr int kMostPackets = 64;

  /// Opens the socket. `clock` outlives the device; DeviceState::time is its time.
  /// @throws Error when an option is out of range or the socket cannot be had.
  explicit RemoteDevice(const Clock& clock, const RemoteDeviceOptions& options = {});
  ~RemoteDevice() override;
  RemoteDevice(const RemoteDevice&) = delete;
  RemoteDevice& operator=(const RemoteDevice&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override { write_wrench({.force = force}); }
  void write_wrench(const Wrench& wrench) noexcept override;
  /// Also why the device is silent. Any thread.
  [[nodiscard]] std::string reason() const override;

  [[nodiscard]] const std::string& path() const noexcept;
  /// Any thread.
  [[nodiscard]] Counts counts() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// $XDG_RUNTIME_DIR/palpate-device.
/// @throws Error when there is no such variable.
[[nodiscard]] std::string default_remote_path();

}  // namespace palpate
