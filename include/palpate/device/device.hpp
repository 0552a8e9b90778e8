#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/geometry/pose.hpp"

namespace palpate {

/// Abilities and limits of one device.
struct DeviceInfo {
  std::string name;  ///< for messages
  /// N, continuous; infinite: any. 0: it renders no force, and a Servo sends it none.
  double maximum_force = 0;
  double maximum_stiffness = 0;  ///< N/m at the hand that its maker allows; 0: unknown
  double damping = 0;            ///< viscous, of the device by itself, N s/m; 0: unknown
  double mass = 0;               ///< that the hand moves with it, kg; 0: unknown
  /// N m about any axis, continuous. 0: the device renders no torque, and a Servo sends it none.
  double maximum_torque = 0;
  double maximum_grip = 0;     ///< N between its fingers, continuous; 0: it renders none
  double angular_damping = 0;  ///< viscous, of its turns, N m s/rad; 0: unknown
  double inertia = 0;  ///< that the hand turns with it, about the lightest axis, kg m2; 0: unknown
  double rate = 1000;  ///< steps per second that it is made for, Hz
  /// s from reading a position to its force's effect, without the time that the force is held;
  /// unset: unknown
  std::optional<double> delay = {};
  double workspace_radius = 0;   ///< of the largest ball in reach, m; 0: unknown
  bool keeps_time = false;       ///< read() blocks until the next step: nothing else paces the loop
  bool has_orientation = false;  ///< it measures the orientation of its tool
  bool has_gripper = false;      ///< it measures the opening of a gripper
};

/// A device at the beginning of a step, in its own frame.
struct DeviceState {
  /// Condition of the device.
  enum class Status {
    ok,
    silent,    ///< not latched: no data from the hand, so no force may be applied; the position is
               ///< the last one reported, or the first after the silence
    finished,  ///< a recording or a simulation has ended, and with it the loop; the last state is
               ///< repeated
    failed,    ///< latched: no force is applied any more; reason() states why
  };

  Status status = Status::ok;
  /// s, on the device's clock: when the hand was read. A state that repeats it holds that reading,
  /// which a Servo takes into account; 0 where each state is a new one. A ServoThread steps by its
  /// own clock.
  double time = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  /// m/s; damping and brake depend on it. Estimate it from positions where it is not measured.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  std::uint32_t buttons = 0;  ///< bit k: button k is down
  /// Rotation from the tool's axes to the device's, of unit length; the identity while the tool is
  /// held along the device's axes, and where the device does not measure it.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double gripper = 0;  ///< opening between its fingers, m; 0 where there is none
  /// rad/s, in the device's axes; where torque is rendered, damping and brake depend on it.
  /// Estimate it from orientations where it is not measured.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
};

/// True when there will be no more steps.
[[nodiscard]] constexpr bool has_ended(DeviceState::Status status) noexcept {
  return status == DeviceState::Status::finished || status == DeviceState::Status::failed;
}

/// A haptic device: measures where the hand is and applies a force to it. It may measure more
/// (orientation, gripper), and apply torque and grip where its info() has a maximum of them.
///
/// One thread uses it, as a sequence of steps: read() once, then write() or write_wrench() once. An
/// implementation may talk to its hardware in either; one whose hardware only answers requests
/// sends in write() and receives in the next read(). Construction opens the device and throws
/// Error; the destructor sets zero force. Between them nothing throws: a failure is latched, read()
/// then repeats the last state with status `failed`, and write() does nothing.
class Device {
 public:
  virtual ~Device() = default;

  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  /// The newest state. Waits only if `info().keeps_time`, for the device's next step and no longer
  /// than two of its periods.
  [[nodiscard]] virtual DeviceState read() noexcept = 0;

  /// Applies a force to the hand, N, device frame, until the next write(). A force that is not
  /// finite is a failure; the device shortens forces above its maximum.
  /// A device that renders torque or grip lets them go to zero.
  virtual void write(const Eigen::Vector3d& force) noexcept = 0;

  /// The same with a torque about the handle (N m, in the device's axes) and a grip (N; above 0 it
  /// opens). By default the force alone is written. It has a name of its own since whoever
  /// overrides one function hides all others of its name.
  virtual void write_wrench(const Wrench& wrench) noexcept { write(wrench.force); }

  /// Why the status is `failed`, or `silent`, and what to do; empty otherwise. Not real-time.
  [[nodiscard]] virtual std::string reason() const = 0;

 protected:
  Device() = default;
  Device(const Device&) = default;
  Device& operator=(const Device&) = default;
};

/// The numbers of a kind of device. Makers seldom publish all of them: unset means unknown, and
/// its user assumes a safe value.
struct DeviceProfile {
  std::string name;                         ///< "omega": for profile=NAME
  std::string title;                        ///< "Force Dimension omega.3"
  std::optional<double> maximum_force;      ///< N, continuous
  std::optional<double> peak_force;         ///< N, for a short time
  std::optional<double> maximum_stiffness;  ///< N/m at the hand
  std::optional<double> maximum_torque;     ///< N m, continuous, of a wrist with motors
  std::optional<double> maximum_grip;       ///< N, continuous, of a gripper with a motor
  std::optional<double> angular_damping;    ///< viscous, of its turns, N m s/rad
  std::optional<double> damping;            ///< viscous, of the device by itself, N s/m
  std::optional<double> coulomb;            ///< dry friction, N
  std::optional<double> mass;               ///< that the hand moves, kg
  std::optional<double> resolution;         ///< of a position, m
  std::optional<double> workspace_radius;   ///< of the largest ball in reach, m
  std::optional<double> rate;               ///< steps per second, Hz
  std::optional<double> delay;              ///< s from reading a position to its force's effect
  std::string source;                       ///< where the figures come from
};

/// The kinds that come with palpate, "unknown" first.
[[nodiscard]] const std::vector<DeviceProfile>& device_profiles();

/// The kind of that name; of one that ends in ".toml", the only kind in that file.
/// @throws Error that lists the kinds, or as read_device_profiles() does.
[[nodiscard]] DeviceProfile device_profile(
    std::string_view name, const std::vector<DeviceProfile>& among = device_profiles());

/// Reads profiles: TOML, one table per kind, with the members above as keys, in SI units.
/// `what`: name of the text in messages.
/// @throws Error that states what is wrong, and where.
[[nodiscard]] std::vector<DeviceProfile> parse_device_profiles(std::string_view toml,
                                                               const std::string& what);

/// Reads a file of profiles.
/// @throws Error as parse_device_profiles(), or when the file cannot be read.
[[nodiscard]] std::vector<DeviceProfile> read_device_profiles(const std::string& path);

/// Maps a device's frame to the world, and magnifies its motion.
///
/// Positions and velocities are rotated and multiplied by `scale`; positions are also translated.
/// Forces are only rotated: a newton that a proxy computes is a newton that the hand feels. Hence
///  - the hand feels a surface of K N/m in the world as scale * K N/m (felt_stiffness()); for it to
///    feel K, give the surface K / scale;
///  - work done on the hand is the world's work F . dh divided by `scale`; its sign, which
///    passivity depends on, is the same in both. Turns are not magnified, so a torque is divided
///    by `scale`: its levers are so much shorter at the hand.
struct Workspace {
  Eigen::Isometry3d T_world_device = Eigen::Isometry3d::Identity();  ///< pose of the device's frame
  double scale = 1;  ///< metres in the world for one metre of the device; > 0

  [[nodiscard]] Eigen::Vector3d position_to_world(const Eigen::Vector3d& device) const noexcept {
    return T_world_device * Eigen::Vector3d(scale * device);
  }
  [[nodiscard]] Eigen::Vector3d position_to_device(const Eigen::Vector3d& world) const noexcept {
    return T_world_device.linear().transpose() * (world - T_world_device.translation()) / scale;
  }
  [[nodiscard]] Eigen::Vector3d velocity_to_world(const Eigen::Vector3d& device) const noexcept {
    return T_world_device.linear() * Eigen::Vector3d(scale * device);
  }
  [[nodiscard]] Eigen::Quaterniond orientation_to_world(
      const Eigen::Quaterniond& device) const noexcept {
    return Eigen::Quaterniond(T_world_device.linear()) * device;
  }
  [[nodiscard]] Eigen::Quaterniond orientation_to_device(
      const Eigen::Quaterniond& world) const noexcept {
    return Eigen::Quaterniond(T_world_device.linear()).conjugate() * world;
  }
  [[nodiscard]] Eigen::Vector3d force_to_device(const Eigen::Vector3d& world) const noexcept {
    return T_world_device.linear().transpose() * world;
  }
  [[nodiscard]] Wrench wrench_to_device(const Wrench& world) const noexcept {
    return {force_to_device(world.force), force_to_device(world.torque) / scale, world.grip};
  }
  /// The stiffness that the hand feels, N/m, of a surface with `world` N/m.
  [[nodiscard]] double felt_stiffness(double world) const noexcept { return scale * world; }
};

}  // namespace palpate
