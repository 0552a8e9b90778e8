#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/device/device.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/tool/tool.hpp"

namespace palpate {

struct StepTrace;

/// Every step of a servo, in order, for one thread that records them. Lock-free; all
/// memory is taken at construction. Where the recorder falls behind by more than there is room for,
/// steps are left out and counted: the servo never waits.
template <class Step>
class Ring {
 public:
  /// Room for `capacity` steps, rounded up to a power of two.
  explicit Ring(std::size_t capacity)
      : size_(std::bit_ceil(capacity)), steps_(std::make_unique<Step[]>(size_)) {}

  /// The servo's: puts a step in. Real-time. False: there was no room.
  bool push(const Step& step) noexcept {
    const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
    if (at - popped_.load(std::memory_order_acquire) == size_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    steps_[at % size_] = step;
    pushed_.store(at + 1, std::memory_order_release);
    return true;
  }

  /// The servo's, before it computes: fetches the memory that the next step goes into, which is far
  /// from the processor where there is room for many. Real-time.
  void prefetch() const noexcept {
    const auto* const slot =
        reinterpret_cast<const char*>(&steps_[pushed_.load(std::memory_order_relaxed) % size_]);
    for (std::size_t at = 0; at < sizeof(Step); at += kCacheLine) __builtin_prefetch(slot + at, 1);
  }

  /// The recorder's: the oldest step, there until drop(); null: empty.
  [[nodiscard]] const Step* front() const noexcept {
    const std::uint64_t at = popped_.load(std::memory_order_relaxed);
    return at == pushed_.load(std::memory_order_acquire) ? nullptr : &steps_[at % size_];
  }
  void drop() noexcept { popped_.fetch_add(1, std::memory_order_release); }

  /// The recorder's: takes the oldest step out; none: empty.
  [[nodiscard]] std::optional<Step> pop() noexcept {
    const Step* const oldest = front();
    if (oldest == nullptr) return std::nullopt;
    std::optional<Step> step = *oldest;
    drop();
    return step;
  }

  /// The recorder's: does it want steps from now on? At first it does.
  void accept(bool on) noexcept { accepts_.store(on, std::memory_order_relaxed); }
  [[nodiscard]] bool accepts() const noexcept { return accepts_.load(std::memory_order_relaxed); }

  /// Is half of the room taken? Any thread.
  [[nodiscard]] bool fills() const noexcept { return 2 * (pushed_ - popped_) > size_; }

  /// Steps that were left out. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(); }

 private:
  static constexpr std::size_t kCacheLine = 64;

  // Threads that write into one cache line wait for each other.
  std::size_t size_;
  std::unique_ptr<Step[]> steps_;
  std::atomic<bool> accepts_{true};
  alignas(kCacheLine) std::atomic<std::uint64_t> pushed_{0};  // the servo writes it, and the next
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> popped_{0};  // the recorder writes it
};

/// The state of a servo after its last step, for those who watch. World frame.
struct ServoState {
  /// Times of a step, measured by the loop that paces the servo, s. Not a number: not measured.
  struct Timing {
    double lateness = std::numeric_limits<double>::quiet_NaN();   ///< after it was due
    double computing = std::numeric_limits<double>::quiet_NaN();  ///< of the thread, without others
  };

  using Queue = Ring<ServoState>;

  std::uint64_t step = 0;                         ///< counts from 1; 0: there was none yet
  double time = 0;                                ///< s, on the clock that snapshots are stamped on
  double dt = 0;                                  ///< since the step before, s
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();  ///< where the hand has the tool, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< of the hand, m/s
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< of the tool
  double gripper = 0;                                               ///< its opening at the hand, m
  Contact contact;  ///< its force is the proxy's own
  /// Where what is held is, outside of the surface: ServoOptions::tool, whose handle is the proxy;
  /// a point is turned and open as the hand is.
  Pose tool;
  Wrench wrench;                                     ///< of the tool's proxy, before the guard
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< what the guard let through, N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< the same, N m; 0: the device renders none
  double grip = 0;                                   ///< the same, N; 0: the device renders none
  Guard::State guard;
  FieldNote field_notes = FieldNote::none;
  DeviceState::Status device = DeviceState::Status::ok;
  std::uint32_t buttons = 0;
  std::size_t patch_points = 0;
  bool paused = false;
  bool clutched = false;  ///< the hand moves freely; the tool rests (ServoOptions::clutch_button)
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< from the hand to the tool, by the clutch, m
  Timing timing;
};

/// Histogram of durations in geometric bins, eight to an octave, from 1/8 us to 17 s. The first and
/// last bins also count everything outside.
struct Durations {
  static constexpr std::size_t kPerOctave = 8;
  static constexpr std::size_t kBins = 27 * kPerOctave;

  std::array<std::uint64_t, kBins> counts{};
  std::uint64_t count = 0;
  double sum = 0;      ///< s
  double longest = 0;  ///< s

  /// s; what is negative counts as 0, what is not a number is left out.
  void add(double duration) noexcept;

  /// The duration that a share `p` (0-1) of all stays below, to 5 %: the middle of its bin, and
  /// never above the longest. 0 when there are none.
  [[nodiscard]] double quantile(double p) const noexcept;
  [[nodiscard]] double mean() const noexcept {
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  /// Durations added after `earlier` was taken. `longest` stays that of all.
  [[nodiscard]] Durations since(const Durations& earlier) const noexcept;
};

/// How late a servo's steps began and how long they took, where measured.
struct StepDurations {
  Durations lateness;
  Durations computing;

  /// Durations added after `earlier` was taken.
  [[nodiscard]] StepDurations since(const StepDurations& earlier) const noexcept {
    return {lateness.since(earlier.lateness), computing.since(earlier.computing)};
  }
};

struct ServoOptions {
  FieldOptions field = {};
  ProxyOptions proxy = {};
  /// What the hand holds; null: a point. Experimental. A device that measures its orientation turns
  /// it, and gets torque and grip where it renders them.
  std::shared_ptr<const Tool> tool = {};
  /// ToolOptions::gyration. Where torque is rendered, 0 stands for the largest up to the tool's
  /// with which turns are stable on the device, at least 10 mm at the hand (docs/method.md 8.1).
  double gyration = 0;
  GuardOptions guard = {};  ///< at the hand; fitted to the device by guard_for()
  Workspace workspace = {};
  /// While this button of the device is down, 0 to 31, the hand moves without the tool.
  std::optional<int> clutch_button = {};
  ServoState::Queue* steps = nullptr;  ///< every step is put into it; outlives the servo
  Ring<StepTrace>* traces = nullptr;   ///< the same with what each was made of, while it accepts
};

/// Settings that may change while a servo runs.
struct ContactSettings {
  double stiffness = 500;  ///< K, N/m
  Friction friction = {};
  Texture texture = {};
};

/// Renders a scene to one hand: SceneField, Proxy and Guard between a device's position and its
/// force; of a tool ToolField and ToolProxy. In palpate::live.
///
/// Owns no thread: a device's callback or a ServoThread calls tick(), or the owner of a loop calls
/// step() and show(). One thread steps; functions marked "any thread" may be called meanwhile.
/// Device and scene outlive it. While the device is silent the force fades to zero at the guard's
/// rate; it returns at that rate, and contact begins with the first valid position.
///
/// While the clutch is held the tool stays at the proxy, which a moving surface may take along. The
/// spring is not stretched when the clutch is released, so force returns only as the hand pushes.
/// The guard's ledger counts the fading force on the hand's own displacement.
class Servo {
 public:
  /// Share of a device's continuous maximum force that is used (docs/method.md 8.6).
  static constexpr double kForceShare = 0.8;
  /// s in which add_force()'s force fades (judgement)
  static constexpr double kAddedForceFade = 0.1;
  /// Steps that forces_since() remembers, 1 s at 1 kHz (judgement)
  static constexpr std::size_t kRecentForces = 1024;

  /// @throws Error when an option is out of its range or the scene has too many readers.
  Servo(Device& device, Scene& scene, const ServoOptions& options = {});
  ~Servo();
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  /// Makes a step: reads the device, computes, writes the force, shows the state. `now`: s, on the
  /// clock of the snapshots' times; it never decreases. noexcept, allocation-free, lock-free, apart
  /// from what the device does in read() and write().
  const ServoState& tick(double now) noexcept;

  /// A step at the device's own time: for simulated time.
  const ServoState& tick() noexcept;

  /// The computing part of a step alone: what it returns has the force for the device, world frame;
  /// write() sends it. Publishes nothing yet. Real-time (docs/architecture.md, contract 1).
  const ServoState& step(const DeviceState& device, double now) noexcept;

  /// Publishes the last step to other threads, with its measured timing. Real-time.
  void show(const ServoState::Timing& timing = {}) noexcept;

  /// Writes what the last step computed to the device, in its frame: the force (zero for a device
  /// without force), and torque and grip where a tool is held and the device renders them.
  /// Real-time, apart from what the device does.
  void write() noexcept;

  [[nodiscard]] Device& device() const noexcept;
  [[nodiscard]] const ServoOptions& options() const noexcept;

  /// The stiffest surface that this device can hold in this workspace, N/m in the world, also in
  /// turns if it renders torque; stiffer settings are reduced to it (docs/method.md 8.1). Infinite
  /// for devices without force.
  [[nodiscard]] double stiffness_limit() const noexcept;

  /// The newest state. Any thread.
  [[nodiscard]] ServoState state() const noexcept;
  /// Lateness and computing time of all steps so far. Any thread.
  [[nodiscard]] StepDurations durations() const noexcept;

  /// Forces that left the guard in the steps after the first `seen`, oldest first, N, world frame;
  /// sets `seen` to the number of steps shown. Holds the last kRecentForces steps; rarer calls miss
  /// some. Any thread; allocates.
  [[nodiscard]] std::vector<Eigen::Vector3f> forces_since(std::uint64_t& seen) const;

  /// Fades the force to zero at the guard's rate, and back. Any thread.
  void pause(bool paused) noexcept;
  /// In the next step, clears faults, contact and clutch shift; tool and proxy move to the hand.
  /// Any thread.
  void reset() noexcept;

  /// Changes stiffness, friction and texture from the next step on. In contact, stiffness changes
  /// as the energy tank allows (docs/method.md 3.5): the hand is given no energy. Any thread; not
  /// real-time.
  /// @throws Error when a value is out of its range.
  void set_contact(const ContactSettings& contact);
  /// Settings set last; they act from the next step on at the latest. Any thread.
  [[nodiscard]] ContactSettings contact() const noexcept;

  /// A force from outside, such as what a robot's sensor feels, N, world frame: it goes through the
  /// guard with the surface's and fades in kAddedForceFade unless the next one comes. Any thread;
  /// not real-time.
  /// @throws Error when it is not finite.
  void add_force(const Eigen::Vector3d& force);

  /// Renders another surface of the same points from the next step on; the guard smooths the change
  /// of force. Any thread; not real-time.
  /// @throws Error when an option is out of its range.
  void set_field(const FieldOptions& field);
  /// The field options in use, from the next step on at the latest. Any thread.
  [[nodiscard]] FieldOptions field() const noexcept;

 private:
  friend class ServoTrace;  // of recordings that are looked at

  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// `options` at the hand of a device: maximum_force is lowered to Servo::kForceShare of what it can
/// hold, silence raised to 2.5 periods of slow ones, mass and delay taken from DeviceInfo.
[[nodiscard]] GuardOptions guard_for(const DeviceInfo& device, GuardOptions options);

}  // namespace palpate
