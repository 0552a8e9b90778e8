#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace palpate {

/// What the guard did to a step's force, as bits.
enum class GuardNote : std::uint32_t {
  none = 0,
  slewed = 1u << 0,   ///< the force changed faster than the hand explains; it follows more slowly
  clamped = 1u << 1,  ///< longer than the device's maximum; shortened to it
  silence = 1u << 2,  ///< watchdog: no step for too long; zero now, and a soft return
  fault = 1u << 3,    ///< latched: zero until reset(); GuardState::fault says why
};

[[nodiscard]] constexpr GuardNote operator|(GuardNote a, GuardNote b) noexcept {
  return static_cast<GuardNote>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr bool has(GuardNote notes, GuardNote bit) noexcept {
  return (static_cast<std::uint32_t>(notes) & static_cast<std::uint32_t>(bit)) != 0;
}

/// Why the force stays at zero.
enum class GuardFault : std::uint8_t {
  none,
  force,   ///< force or stiffness were not finite, or absurdly large
  hand,    ///< the hand's place or velocity was
  time,    ///< the time since the last step was not finite, or negative
  proxy,   ///< the proxy has latched a fault (ContactNote::fault)
  device,  ///< the device has failed
};

struct GuardOptions {
  double maximum_force = std::numeric_limits<double>::infinity();  ///< N; > 0
  double slew = 300;      ///< S: how fast a force may change that the hand does not explain, N/s
  double damping = 0;     ///< B of a damper between proxy and hand, N s/m; 0: there is none
  double silence = 5e-3;  ///< steps further apart than this trip the watchdog, s; infinite: none
};

/// What the guard is told of a step. World frame.
struct GuardInput {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< the proxy's, on the hand, N
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();       ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the hand, m/s
  double dt = 0;                                       ///< since the last step, s
  double stiffness = 0;                                ///< K that made the force, N/m
  GuardFault fault = GuardFault::none;                 ///< known already
};

/// How often each link stepped in, since construction.
struct GuardCounts {
  std::uint64_t steps = 0;
  std::uint64_t slewed = 0;
  std::uint64_t clamped = 0;
  std::uint64_t silences = 0;
  std::uint64_t faults = 0;  ///< times that one was latched, not steps spent in it
};

struct GuardState {
  GuardNote notes = GuardNote::none;  ///< of the last step
  GuardFault fault = GuardFault::none;
  GuardCounts counts;
};

/// Everything between the proxy's force and the device: a chain of links, each of which lets a good
/// force pass bit for bit (algorithm.md section 8).
///
///  1. Fault: what is not finite gives zero at once, and zero until reset().
///  2. Watchdog: after a silence the hand may be anywhere. Zero; the links below lead back softly.
///  3. Slew of unexplained changes: |F - F_before| <= K |h - h_before| + B |v - v_before| + S dt.
///     What the hand does itself is never delayed; pops of a new cloud, edges, switching on are.
///  4. Clamp: |F| <= maximum_force, the direction kept.
///
/// One thread uses it. Everything but construction is real-time: no allocation, no clock, bounded.
class Guard {
 public:
  /// Larger numbers than this (N, m, m/s, N/m) are a fault: nothing here makes them.
  static constexpr double kLargest = 1e9;

  /// @throws Error when an option is out of its range.
  explicit Guard(const GuardOptions& options = {});

  /// The force that may go to the device, N. Finite, whatever the input.
  [[nodiscard]] Eigen::Vector3d pass(const GuardInput& input) noexcept;

  /// Forgets a fault and where the hand was; the next force comes up from zero.
  void reset() noexcept;

  [[nodiscard]] const GuardState& state() const noexcept { return state_; }
  [[nodiscard]] const GuardOptions& options() const noexcept { return options_; }

 private:
  [[nodiscard]] Eigen::Vector3d limit_change(const GuardInput& input,
                                             const Eigen::Vector3d& force) noexcept;
  [[nodiscard]] Eigen::Vector3d limit_length(const Eigen::Vector3d& force) noexcept;
  [[nodiscard]] Eigen::Vector3d remember(const GuardInput& input,
                                         const Eigen::Vector3d& force) noexcept;
  [[nodiscard]] Eigen::Vector3d fail(GuardFault fault) noexcept;
  void note(GuardNote bit, std::uint64_t& count) noexcept;

  GuardOptions options_;
  GuardState state_;
  GuardInput before_;  // its force is the one that was let through
  bool started_ = false;
};

/// Why the force stays at zero and what to do; empty for none.
[[nodiscard]] std::string_view in_words(GuardFault fault) noexcept;

/// What the guard did in the last step and why, in one line; empty when it did nothing.
[[nodiscard]] std::string in_words(const GuardState& state);

}  // namespace palpate
