#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "base/latest.hpp"
#include "palpate/servo/servo.hpp"
#include "servo/hand_rhythm.hpp"
#include "servo/step_trace.hpp"

namespace palpate {

/// Durations that one thread adds to while others look. Lock-free; adding is real-time.
class Histogram {
 public:
  /// s; what is negative counts as 0, what is not a number is left out.
  void add(double duration) noexcept;

  /// Counts so far; a step in progress may be in some numbers and not in others.
  [[nodiscard]] Durations look() const noexcept;

 private:
  std::array<std::atomic<std::uint64_t>, Durations::kBins> counts_{};
  std::atomic<double> sum_{0};
  std::atomic<double> longest_{0};
};

/// The forces of a servo's last steps, for any number of those who watch. The servo writes over the
/// oldest and waits for nobody; who watches more rarely than every kSteps steps misses some.
class RecentForces {
 public:
  static constexpr std::size_t kSteps = Servo::kRecentForces;

  /// N. One thread. Real-time.
  void add(const Eigen::Vector3f& force) noexcept;

  /// Number of forces added so far. Any thread.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(); }

  /// Forces added after the first `seen` that are still held, oldest first; sets `seen` to count().
  /// Any thread; allocates.
  [[nodiscard]] std::vector<Eigen::Vector3f> since(std::uint64_t& seen) const;

 private:
  // A slot is written with release and read with acquire: a reader that meets a newer force than
  // expected also sees the newer count.
  using Slot = std::array<std::atomic<float>, 3>;

  std::array<Slot, kSteps> forces_{};
  std::atomic<std::uint64_t> count_{0};
};

/// Lets a hand move without its tool. At the end of a device's reach, hold the clutch, move the
/// hand back, release it: the tool goes on from where it rested, further than any device reaches.
///
/// The tool is where the hand is, shifted by all that the hand moved while the clutch was held.
/// Positions in one frame, m. Real-time.
class Clutch {
 public:
  /// The tool's position while the hand is at `hand`: `rest`, finite, while the clutch is `held`;
  /// then it moves on from there as the hand does. A hand that is not finite moves nothing, and
  /// the result is not finite.
  [[nodiscard]] Eigen::Vector3d tool(const Eigen::Vector3d& hand, bool held,
                                     const Eigen::Vector3d& rest) noexcept {
    if (!held || !hand.allFinite()) return hand + shift_;
    shift_ = rest - hand;
    return rest;
  }

  /// The same of how a tool is turned and open; `rest` is finite.
  [[nodiscard]] Pose turned(const Pose& hand, bool held, const Pose& rest) noexcept {
    if (held && hand.orientation.coeffs().allFinite() && std::isfinite(hand.opening)) {
      turn_ = hand.orientation.conjugate() * rest.orientation;
      opened_ = rest.opening - hand.opening;
      return {hand.position, rest.orientation, rest.opening};
    }
    return {hand.position, hand.orientation * turn_, hand.opening + opened_};
  }

  /// Offset from the hand to the tool while the clutch is not held, m.
  [[nodiscard]] const Eigen::Vector3d& shift() const noexcept { return shift_; }

 private:
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();
  double opened_ = 0;  // m
};

/// A force from outside (Servo::add_force()) that fades unless the next one comes.
class AddedForce {
 public:
  /// N, finite. One thread at a time.
  void set(const Eigen::Vector3d& force) noexcept { newest_.set(force); }

  /// Adds what is left of it in the step at `time`, s; nothing changes a bit where there is none.
  /// The one that is new in this step, if any. The stepping thread's; real-time.
  std::optional<Eigen::Vector3d> add_to(Eigen::Vector3d& force, double time) noexcept {
    const std::optional<Eigen::Vector3d> newest = news(newest_, seen_);
    if (newest) {
      force_ = *newest;
      time_ = time;
    }
    const double share = 1 - (time - time_) / Servo::kAddedForceFade;
    if (share > 0 && !force_.isZero(0)) force += share * force_;
    return newest;
  }

 private:
  Latest<Eigen::Vector3d> newest_;
  std::uint64_t seen_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  double time_ = 0;
};

/// What others see of a servo's steps. One thread shows, any looks.
struct ShownSteps {
  Latest<ServoState> state;
  RecentForces forces;
  Histogram lateness;
  Histogram computing;

  /// Real-time.
  void show(const ServoState& now) noexcept {
    lateness.add(now.timing.lateness);
    computing.add(now.timing.computing);
    state.set(now);
    forces.add(now.force.cast<float>());
  }
};

/// What other threads request of a servo's step, which never waits for them.
struct Requests {
  explicit Requests(const ServoOptions& options)
      : contact({options.proxy.stiffness, options.proxy.friction, options.proxy.texture}),
        field(options.field) {}

  /// Takes what is new, but for the added force. The stepping thread's; real-time.
  void take(ServoState& state, StepInput& basis) noexcept {
    state.paused = paused.load();
    basis.reset = reset.exchange(false);
    basis.contact = news(contact, contact_seen);
    basis.field = news(field, field_seen);
  }

  std::mutex mutex;  // between those who change what is felt; the step never takes it
  Latest<ContactSettings> contact;
  Latest<FieldOptions> field;
  std::uint64_t contact_seen = 0;
  std::uint64_t field_seen = 0;
  AddedForce added;
  std::atomic<bool> paused{false};
  std::atomic<bool> reset{false};
};

/// The stiffest surface that a hand's device bears, N/m in the world.
struct StiffnessLimit {
  static constexpr double kAny = std::numeric_limits<double>::infinity();

  double told = kAny;     ///< as often as the device told that it is read
  double passive = kAny;  ///< the same where its maker limits nothing
  double span = 0;        ///< T + 2 T_d of the device, s
  double damped = kAny;   ///< s: the guard's damper is too strong for readings further apart

  /// The same of a hand that is read as rarely as it is. A reading that comes later holds position
  /// and force for so much longer, and takes the force so much later.
  [[nodiscard]] double at(const HandRhythm& rhythm) const noexcept {
    const double late = rhythm.late();
    if (!(late > 0) || told == kAny) return told;
    const double damper = std::min(1.0, damped / rhythm.period());
    return std::min(told, damper * passive * span / (span + 3 * late));
  }
};

/// A point on surfaces that are no stiffer than the hand's device bears.
struct LimitedProxy {
  LimitedProxy(const ProxyOptions& options, const StiffnessLimit& its_limit, double rate)
      : limit(its_limit),
        wanted{options.stiffness, options.friction, options.texture},
        rhythm(rate),
        bearable(limit.told),
        proxy(softened(options, limit.told)) {}

  /// False: what is felt stays as it is.
  bool change(const std::optional<ContactSettings>& settings) noexcept {
    const double bears = limit.at(rhythm);
    const bool same = std::min(wanted.stiffness, bears) == std::min(wanted.stiffness, bearable);
    bearable = bears;
    if (!settings && same) return false;
    if (settings) wanted = *settings;
    proxy.change(std::min(wanted.stiffness, bearable), wanted.friction, wanted.texture);
    return true;
  }
  /// Is a stiffer surface requested than the hand's device bears?
  [[nodiscard]] bool is_softened() const noexcept { return wanted.stiffness > bearable; }

  // The options with no more stiffness than that.
  [[nodiscard]] static ProxyOptions softened(ProxyOptions proxy, double limit) {
    proxy.stiffness = std::min(proxy.stiffness, limit);
    return proxy;
  }

  StiffnessLimit limit;
  ContactSettings wanted;
  HandRhythm rhythm;  // of the hand
  double bearable;    // the limit at that, N/m
  Proxy proxy;
  std::optional<SceneField> field;  // none: a tool is held in its place
};

/// The options with a guard that is fitted to the device, and a gyration with which it holds the
/// turns of a tool if it renders torque.
/// @throws Error for a clutch that is no button, and a maximum force below 0.
[[nodiscard]] ServoOptions options_for(const DeviceInfo& device, ServoOptions options);

/// The hand's limit divided by the magnification, that of turns too if the device renders torque.
[[nodiscard]] StiffnessLimit stiffness_limit_of(const DeviceInfo& device,
                                                const ServoOptions& options);

}  // namespace palpate
