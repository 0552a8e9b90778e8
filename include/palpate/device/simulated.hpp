#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "palpate/device/device.hpp"
#include "palpate/device/hand_guide.hpp"
#include "palpate/device/playback.hpp"

namespace palpate {

/// A hand as a spring and a damper that pull the device after the place where the hand wants to be.
/// The defaults are a light grip (docs/method.md 8.1).
struct SimulatedHand {
  double stiffness = 300;    ///< N/m; 0 and no damping: nobody holds the device
  double damping = 3;        ///< N s/m
  double maximum_force = 8;  ///< N; a hand that is held back harder gives way: it pulls no more
};

struct SimulatedDeviceOptions {
  double mass = 0.1;          ///< moved by the hand, kg; > 0
  double damping = 0.5;       ///< viscous, N s/m
  double coulomb = 0.05;      ///< dry friction, N; holds a resting device against smaller forces
  double resolution = 3e-5;   ///< a step of the encoders along each axis, m; 0: continuous
  int delay = 1;              ///< steps from the reading of a position to its force's effect, 0-16
  double rate = 1000;         ///< steps a second, Hz
  double maximum_force = 20;  ///< N; longer forces are shortened to it
  double workspace_radius = 0.1;  ///< m; only told, never enforced
  SimulatedHand hand = {};
  /// at time 0, m; a target's start and a guide's first wish win
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at time 0, m/s
  /// s after which the status is `finished`, 0 for one step at least; unset: at the end of the
  /// target, never where there is none
  std::optional<double> duration = {};
};

/// A device that exists in simulated time only: a point mass with viscous and dry friction, read
/// through encoders, driven by a held (zero-order) and delayed force and by a hand.
///
///   M x'' = F(t_k - delay) - b x' - f_c x'/|x'| + k_h (g - x) + b_h (g' - x')
///
/// between steps k and k + 1; g, where the hand wants to be, is straight between steps. Integration
/// is exact (matrix exponential) but for the direction of dry friction, which is held for 1/16 of
/// a step; on a straight line that is exact too. Every step takes one read() and one write();
/// read() brings the device to the next step's time, the first one to time 0. Same input, same
/// bits.
class SimulatedDevice final : public Device {
 public:
  /// `target`: where the hand wants to be, device frame, times from 0; empty: at the starting
  /// place.
  /// @throws Error when an option is out of range or the target is no trajectory.
  explicit SimulatedDevice(const SimulatedDeviceOptions& options = {}, Trajectory target = {});

  /// The hand wants to be where `guide`, which outlives the device, says; asked once a step.
  /// @throws Error when an option is out of range.
  SimulatedDevice(const SimulatedDeviceOptions& options, HandGuide& guide);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override;
  [[nodiscard]] std::string reason() const override;

  /// The true position and velocity, which no encoder shows, m and m/s.
  [[nodiscard]] const Eigen::Vector3d& true_position() const noexcept { return position_; }
  [[nodiscard]] const Eigen::Vector3d& true_velocity() const noexcept { return velocity_; }

  /// What the forces that acted on the hand gave to it so far, J; below zero: took from it.
  [[nodiscard]] double work() const noexcept { return work_; }

 private:
  static constexpr std::size_t kMaximumDelay = 16;

  [[nodiscard]] HandWish wanted(double time) noexcept;
  [[nodiscard]] Eigen::Vector3d within_reach(const Eigen::Vector3d& goal) const noexcept;
  [[nodiscard]] Eigen::Vector3d quantised() const noexcept;
  void begin() noexcept;
  void advance() noexcept;
  void fail(const char* wrong) noexcept;
  void advance_with_friction(const Eigen::Vector3d& push,
                             const Eigen::Vector3d& push_rate) noexcept;
  void slide(double duration, Eigen::Vector3d push, const Eigen::Vector3d& push_rate) noexcept;
  void flow(const Eigen::Matrix4d& transition, const Eigen::Vector3d& push,
            const Eigen::Vector3d& push_rate) noexcept;

  SimulatedDeviceOptions options_;
  Playback target_;
  HandGuide* guide_ = nullptr;
  HandWish wish_;  // at the current time
  DeviceInfo info_;
  Eigen::Matrix4d generator_;   // of (x, v, push, push rate)
  Eigen::Matrix4d whole_step_;  // its exponential over one step
  Eigen::Matrix4d part_step_;   // ... and over 1/16 of one
  Eigen::Vector3d position_;
  Eigen::Vector3d velocity_;
  std::array<Eigen::Vector3d, kMaximumDelay + 1> forces_;  // ring of written forces
  double work_ = 0;
  std::uint64_t steps_ = 0;
  DeviceState state_;
  bool started_ = false;
  const char* wrong_ = nullptr;  // what was not finite, once the device has failed
};

}  // namespace palpate
