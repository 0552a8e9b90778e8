#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/device/device.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/servo/guard.hpp"

namespace palpate {

/// What whoever paces a servo measured of a step, s. Not a number: not measured.
struct StepTiming {
  double lateness = std::numeric_limits<double>::quiet_NaN();   ///< after it was due
  double computing = std::numeric_limits<double>::quiet_NaN();  ///< of the thread, without others
};

/// All that a servo knows of its last step, for those who watch. World frame.
struct ServoState {
  std::uint64_t step = 0;                         ///< counts from 1; 0: there was none yet
  double time = 0;                                ///< s, on the clock that snapshots are stamped on
  double dt = 0;                                  ///< since the step before, s
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();  ///< where the hand has the tool, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< of the hand, m/s
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< of the tool
  double gripper = 0;                                               ///< its opening at the hand, m
  Contact contact;                                  ///< its force is the proxy's own
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< what the guard let through, N
  GuardState guard;
  FieldNote field_notes = FieldNote::none;
  DeviceStatus device = DeviceStatus::ok;
  std::uint32_t buttons = 0;
  std::size_t patch_points = 0;
  bool paused = false;
  bool clutched = false;  ///< the hand moves freely; the tool rests (ServoOptions::clutch_button)
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< from the hand to the tool, by the clutch, m
  StepTiming timing;
};

/// The forces of a servo's last steps, for any number of those who watch. The servo writes over the
/// oldest and waits for nobody; who watches more rarely than every kSteps steps misses some.
class RecentForces {
 public:
  static constexpr std::size_t kSteps = 1024;

  /// N. One thread. Real-time.
  void add(const Eigen::Vector3f& force) noexcept;

  /// How many were added until now. Any thread.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(); }

  /// What was added after the first `seen`, oldest first, as far as it is still there; `seen`
  /// becomes count(). Any thread; allocates.
  [[nodiscard]] std::vector<Eigen::Vector3f> since(std::uint64_t& seen) const;

 private:
  // A place is written with release and read with acquire: who reads a newer force than expected
  // also sees a count that tells so.
  using Place = std::array<std::atomic<float>, 3>;

  std::array<Place, kSteps> forces_{};
  std::atomic<std::uint64_t> count_{0};
};

/// Every step of a servo, in order, for one thread that records them. Lock-free; all memory is
/// taken at construction. Where the recorder falls behind by more than there is room for, steps are
/// left out and counted: the servo waits for nobody.
class StepQueue {
 public:
  /// Room for `capacity` steps, rounded up to a power of two.
  explicit StepQueue(std::size_t capacity);
  ~StepQueue();
  StepQueue(const StepQueue&) = delete;
  StepQueue& operator=(const StepQueue&) = delete;

  /// The servo's: puts a step in. Real-time. False: there was no room.
  bool push(const ServoState& state) noexcept;

  /// The recorder's: takes the oldest step out; none: empty.
  [[nodiscard]] std::optional<ServoState> pop() noexcept;

  /// Steps that were left out. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(); }

 private:
  static constexpr std::size_t kCacheLine = 64;

  // Threads that write into one cache line wait for each other.
  std::size_t size_;
  std::unique_ptr<ServoState[]> steps_;
  alignas(kCacheLine) std::atomic<std::uint64_t> pushed_{0};  // the servo writes it, and the next
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> popped_{0};  // the recorder writes it
};

}  // namespace palpate
