// Devices without hardware: SimulatedDevice has mass and is held by a hand, ScriptedDevice plays a
// trajectory. Both run in simulated time; PacedDevice runs them in real time.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/target_source.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate {

/// A wrist that turns about the handle. The defaults are those of the device at a lever of
/// 30 mm, half of a stylus.
struct SimulatedWrist {
  /// The hand as a spring and a damper that turn the tool towards the hand's orientation.
  struct Hand {
    double stiffness = 0.27;       ///< N m/rad; 0 and no damping: nobody holds it
    double damping = 2.7e-3;       ///< N m s/rad
    double maximum_torque = 0.24;  ///< N m; a hand that is held back harder yields
  };

  /// About the tool's axes, which are its principal ones, kg m2; > 0
  Eigen::Vector3d inertia = Eigen::Vector3d::Constant(9e-5);
  double damping = 4.5e-4;     ///< viscous, N m s/rad
  double coulomb = 1.5e-3;     ///< dry friction, N m; holds a resting wrist
  double resolution = 2.5e-4;  ///< a step of the encoders, rad (0.014 degrees); 0: continuous
  double maximum_torque = 0;   ///< of its motors, N m; larger torques are shortened; 0: it has none
  Hand hand = {};
  /// at time 0; a source's first target takes precedence
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at time 0, rad/s, device's axes
};

struct SimulatedDeviceOptions {
  /// A hand as a spring and a damper that pull the device towards the hand's target. The defaults
  /// are a light grip (docs/method.md 8.1).
  struct Hand {
    double stiffness = 300;    ///< N/m; 0 and no damping: nobody holds the device
    double damping = 3;        ///< N s/m
    double maximum_force = 8;  ///< N; a hand that is held back harder yields: it pulls no more
  };

  double mass = 0.1;          ///< moved by the hand, kg; > 0
  double damping = 0.5;       ///< viscous, N s/m
  double coulomb = 0.05;      ///< dry friction, N; holds a resting device against smaller forces
  double resolution = 3e-5;   ///< a step of the encoders along each axis, m; 0: continuous
  int delay = 1;              ///< steps from reading a position to its force's effect, 0-16
  double rate = 1000;         ///< steps per second, Hz
  double maximum_force = 20;  ///< N; longer forces are shortened to it
  double workspace_radius = 0.1;  ///< m; only reported, never enforced
  Hand hand = {};
  std::optional<SimulatedWrist> wrist = {};  ///< unset: it does not turn
  /// at time 0, m; a trajectory's start and a source's first target take precedence
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at time 0, m/s
  /// s after which the status is `finished`, 0 for one step at least; unset: at the end of the
  /// trajectory, never where there is none
  std::optional<double> duration = {};
};

/// A simulated device: a point mass with viscous and dry friction, read through encoders, driven by
/// a held (zero-order) and delayed force and by a hand.
///
///   M x'' = F(t_k - delay) - b x' - f_c x'/|x'| + k_h (g - x) + b_h (g' - x')
///
/// between steps k and k + 1; g, the hand's target, is linear between steps. Where the hand's pull,
/// k_h (g - x) + b_h g', would be more than its largest force it is shortened to that; what is left
/// of the damper, -b_h x', only brakes. Integration is exact (matrix exponential) but for the
/// direction of dry friction, which is held for 1/16 of a step; on a straight line that is exact
/// too. A wrist turns in the same way, with its moments of inertia in the place of the mass and the
/// turns from the tool to the hand's orientation in that of g - x; it is integrated in 16 parts of
/// a step, with damping and friction implicit. Position and turn are coupled by what is touched
/// alone. A gripper is as far open as the hand has it. Every step takes one read() and one write();
/// read() brings the device to the next step's time, the first one to time 0. Same input, same
/// bits.
class SimulatedDevice final : public Device {
 public:
  /// `target`: the hand's target, device frame, times from 0; empty: the starting position.
  /// @throws Error when an option is out of range or the target is not a valid trajectory.
  explicit SimulatedDevice(const SimulatedDeviceOptions& options = {}, Trajectory target = {});

  /// The hand's target comes from `source`, which outlives the device; called once a step.
  /// @throws Error when an option is out of range.
  SimulatedDevice(const SimulatedDeviceOptions& options, TargetSource& source);
  ~SimulatedDevice() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override { write_wrench({.force = force}); }
  void write_wrench(const Wrench& wrench) noexcept override;
  [[nodiscard]] std::string reason() const override;

  /// The true position and velocity, without encoders, m and m/s.
  [[nodiscard]] const Eigen::Vector3d& true_position() const noexcept;
  [[nodiscard]] const Eigen::Vector3d& true_velocity() const noexcept;

  /// The true orientation, without encoders; the identity without a wrist.
  [[nodiscard]] const Eigen::Quaterniond& true_orientation() const noexcept;

  /// Work that the applied forces and torques did on the hand so far, J; negative: taken from it.
  [[nodiscard]] double work() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Plays a trajectory, one row a step, in simulated time. The hand follows the trajectory whatever
/// the force; its velocity is the mean since the row before.
class ScriptedDevice final : public Device {
 public:
  /// @throws Error as check() does.
  explicit ScriptedDevice(Trajectory trajectory);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override;
  [[nodiscard]] std::string reason() const override;

  /// The force of the last write(), N, device frame.
  [[nodiscard]] const Eigen::Vector3d& force() const noexcept { return force_; }

 private:
  Trajectory rows_;
  DeviceInfo info_;
  DeviceState state_;
  std::size_t next_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  bool failed_ = false;
};

/// Runs a device in simulated time (a simulation, a recording) on a clock: each read() steps it up
/// to the clock's time. While the reader is late the device goes on under the force that was
/// written last, as a real one would, for `most_steps`. Its time 0 is the first read().
class PacedDevice final : public Device {
 public:
  static constexpr int kMostSteps = 200;

  /// Device and clock outlive it; nobody else uses the device. `most_steps`: that one read()
  /// catches up; after a longer gap the device's time lags behind.
  PacedDevice(Device& device, const Clock& clock, int most_steps = kMostSteps);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override { device_.write(force); }
  void write_wrench(const Wrench& wrench) noexcept override { device_.write_wrench(wrench); }
  [[nodiscard]] std::string reason() const override { return device_.reason(); }

 private:
  Device& device_;
  const Clock& clock_;
  int most_steps_;
  DeviceInfo info_;
  DeviceState state_;
  double start_ = 0;  // the clock's time at the device's time 0, s
  bool started_ = false;
};

/// @throws Error that names the row when a trajectory is empty, not finite, or its times do not
/// grow strictly.
void check(const Trajectory& trajectory);

/// A way to a place: straight from corner to corner. The last one is the place.
struct Way {
  static constexpr std::size_t kMost = 32;  ///< of an arc; then its pieces turn by 6 degrees

  std::array<Eigen::Vector3d, kMost> corners;  ///< m, device frame
  std::size_t size = 0;                        ///< 0: there is none
  double speed = 0;                            ///< of the hand on it, m/s; > 0
};

/// A tool that is taken, moved and released from outside: by a page's mouse, over a network, by
/// another program. One thread at a time sends; any number of others read, without locks.
class RemoteTarget {
 public:
  /// The newest command to a tool.
  struct Command {
    TargetSource::Target target;
    double stamp = 0;         ///< of the target, s, on the sender's clock
    bool held = false;        ///< somebody holds the tool
    std::uint64_t moves = 0;  ///< targets that were sent so far
    Way way = {};             ///< that leads to the target; none: the hand goes there straight
    std::uint64_t ways = 0;   ///< that were begun so far
  };

  RemoteTarget();
  ~RemoteTarget();

  /// Takes the tool, unless it is held already, and moves it. `stamp`: s, on the sender's clock;
  /// grows from call to call. False: ignored, since it is not finite, pulls with no force, or its
  /// orientation has not unit length. Wait-free, as all that follows.
  bool move(const TargetSource::Target& target, double stamp) noexcept;

  /// Takes the tool as move() does. It goes to the last corner of `way`, which takes the place of
  /// the target's position. `begins`: the hand begins it where it is; otherwise `way` is the one
  /// before, but for its end; one with another number of corners begins all the same. False:
  /// ignored, also where there is no way, a corner is not finite, or the speed is not above 0.
  bool fly(const TargetSource::Target& target, const Way& way, bool begins, double stamp) noexcept;

  /// The user of the tool is still connected and keeps it still: a mouse that rests sends
  /// nothing, so its connection calls this, more often than the reader's command_timeout.
  void keep_alive() noexcept;

  void release() noexcept;

  /// The newest command; none when the sender was too fast for a consistent copy.
  [[nodiscard]] std::optional<Command> command() const noexcept;
  /// Grows with every call above that had an effect.
  [[nodiscard]] std::uint64_t generation() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// A part of a trajectory in which the hand presses against what holds it back.
struct Press {
  double begin = 0, end = 0;  ///< s, on the trajectory
  double resume = 0;  ///< s: where the trajectory is off the surface again, not before `end`
  double pull = 0;    ///< m; a hand that is held back stays farther from its target
  /// m: corners of a way off the surface, over the press from its begin to where the trajectory is
  /// at `resume`; empty: there is none
  std::vector<Eigen::Vector3d> over = {};
};

struct TeleoperatedHandOptions {
  double speed = 0.5;          ///< limit of the target's speed, but on the trajectory, m/s; > 0
  double travel_speed = 0.25;  ///< of the target on its way from touch to touch, m/s; > 0
  /// N that the hand pulls with at most on its trajectory; > 0
  double force = std::numeric_limits<double>::infinity();
  double braking = 10;              ///< m/s^2 with which the target comes to rest at a command; > 0
  double command_timeout = 0.1;     ///< s without a command after which the tool is released; > 0
  double release_time = 0.2;        ///< time constant in which the hand ceases to pull, s; > 0
  double return_after = 3;          ///< s from the release until the trajectory goes on; 0 or more
  std::vector<Press> presses = {};  ///< on the trajectory, in the order of their times
};

/// A hand that plays a trajectory again and again, such as that of plan_exploration(), until
/// somebody takes the tool; then it follows the commands, and some time after the release it
/// returns to the trajectory.
///
///  - A way that a command names begins where the hand is, and ends slowly.
///  - To the trajectory's beginning, and back to where it was interrupted or, if that was a press,
///    to the press's `resume`, the target moves at `travel_speed` from where the hand is, and the
///    hand pulls with 1 N at most until it has caught up. The trajectory waits for it.
///  - A hand that nothing held back for 50 ms of a press has lost what it pressed (a rim, a hole),
///    and one that is 8 times its `pull` behind is caught by an edge:
///    it lifts to the nearest place of the press's `over`, and goes along that and on from there.
///  - Commands are interpolated between their irregular times, and followed no faster than `speed`
///    and than comes to rest there by `braking`.
///  - What it holds turns after the commands as fast as a hand of 80 mm moves its edge at `speed`,
///  stays so when released, and turns back where the trajectory goes on.
///  - A command that limits the hand's force does so after its release, too. Where the next has no
///  limit the target begins at the device.
///  - A command that is overdue counts as a release: the target moves to where the device is, so
///    that nothing pulls any more and the surface pushes it out.
///
/// Same commands at the same times, same bits. One thread calls target(); others send to the
/// RemoteTarget.
class TeleoperatedHand final : public TargetSource {
 public:
  /// `trajectory`: device frame; empty: none. `remote` outlives it.
  /// @throws Error when an option is out of range or the trajectory is not valid.
  explicit TeleoperatedHand(const RemoteTarget& remote, Trajectory trajectory = {},
                            const TeleoperatedHandOptions& options = {});
  ~TeleoperatedHand() override;

  [[nodiscard]] Target target(double time, const Eigen::Vector3d& position) noexcept override;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
