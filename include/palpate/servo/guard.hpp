#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

namespace palpate {

/// Actions of the guard on a step's force, as bits.
enum class GuardNote : std::uint32_t {
  none = 0,
  slewed = 1u << 0,    ///< the force changed faster than the hand explains; it follows more slowly
  clamped = 1u << 1,   ///< longer than the device's maximum; shortened to it
  silence = 1u << 2,   ///< watchdog: no step for too long; zero now, and a soft return
  fault = 1u << 3,     ///< latched: zero until reset(); Guard::State::fault states why
  braked = 1u << 4,    ///< the hand had been given energy; a brake takes it back
  starting = 1u << 5,  ///< a force comes up softly: after a start, a pause, a silence or a fault
  softened = 1u << 6,  ///< rendered softer than requested: the device could not hold that
};

[[nodiscard]] constexpr GuardNote operator|(GuardNote a, GuardNote b) noexcept {
  return static_cast<GuardNote>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr bool has(GuardNote notes, GuardNote bit) noexcept {
  return (static_cast<std::uint32_t>(notes) & static_cast<std::uint32_t>(bit)) != 0;
}

struct GuardOptions {
  /// Options of the brake that takes back energy given to the hand.
  struct Passivity {
    bool on = true;
    double mass = 0.1;     ///< moved with the hand, kg: bounds the brake
    double memory = 0.02;  ///< J: what was taken from the hand beyond this hides nothing later
    double forget = 1;     ///< s in which that memory falls to 1/e
    int delay = 1;         ///< steps from a force's being sent to its effect, 0-16
  };

  /// Off, for simulated time: finite forces go out as they are, of any stiffness. Faults still end
  /// in zero force.
  bool on = true;
  double maximum_force = std::numeric_limits<double>::infinity();  ///< N; > 0
  double slew = 300;        ///< S: how fast a force may change that the hand does not explain, N/s
  double damping = 1;       ///< B of a damper between surface and hand, in contact, N s/m; 0: none
  double silence = 5e-3;    ///< steps further apart than this trip the watchdog, s; infinite: none
  double soft_start = 0.5;  ///< s in which forces come up after a start; 0: at once
  double stiffness_share = 0.8;  ///< most stiffness, as a share of the passive one; infinite: any
  Passivity passivity = {};
};

/// Everything between the proxy's force and the device: a chain of links, each of which lets a good
/// force pass bit for bit (docs/method.md 8).
///
///  1. Fault: what is not finite gives zero at once, and zero until reset().
///  2. Watchdog: after a silence the hand may be anywhere. Zero; the links below lead back softly.
///  3. Damper: in contact, beside the spring: -B (n (n . v) + (1 - s) v_t), v the hand's velocity
///     against the surface, smoothed, v_t its component along the surface, and s the share of that
///     in which the proxy goes along: what is held is damped, what slides is hardly dragged (in a
///     bowl, where the proxy's path is shorter than the hand's, by that share). It never makes the
///     surface attract.
///  4. Soft start: the force comes up from zero while nothing is touched; in contact only as far as
///     the hand has paid for, since a spring that grows stiffer while stretched gives energy.
///  5. Slew of unexplained changes: |F - F_before| <= K |h - h_before| + B |v - v_before| + S dt.
///     What the hand does itself is never delayed; pops of a new cloud, edges, switching on are.
///     What fades in the air goes with the hand, K |h - h_before|, once it gives more than was
///     paid.
///  6. Passivity: a brake against the hand's motion takes back what the hand was given.
///  7. Clamp: |F| <= maximum_force, the direction kept; before the slew and behind the brake.
///
/// The stiffness limit, which comes before the proxy, is the servo's (Servo::stiffness_limit). One
/// thread uses a guard. Everything but construction is real-time: no allocation, no clock, bounded.
class Guard {
 public:
  /// Why the force stays at zero.
  enum class Fault : std::uint8_t {
    none,
    force,  ///< force or stiffness were not finite, or absurdly large
    hand,   ///< hand position or velocity not finite, or absurdly large
    time,   ///< the time since the last step was not finite, or negative
    proxy,  ///< the proxy has latched a fault (ContactNote::fault), as of a hand that is not finite
    device,  ///< the device has failed
  };

  /// Input of one step. World frame.
  struct Input {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< the proxy's, on the hand, N
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< of the touched surface; 0: none is
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();     ///< velocity of that surface, m/s
    Eigen::Vector3d hip = Eigen::Vector3d::Zero();       ///< m; goes as the hand itself does
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the hand, m/s
    double dt = 0;                                       ///< since the last step, s
    /// False: the hand was not read since the last step, and its position is held. What is judged
    /// by its motion waits for the next reading, and takes the whole time in between for it.
    bool fresh = true;
    double stiffness = 0;       ///< K that made the force, N/m
    bool felt = true;           ///< false: the force goes to zero and starts softly again
    bool softened = false;      ///< a stiffer surface was requested
    Fault fault = Fault::none;  ///< found already
  };

  struct State {
    /// Number of steps in which each link acted, since construction.
    struct Counts {
      std::uint64_t steps = 0;
      std::uint64_t slewed = 0;
      std::uint64_t clamped = 0;
      std::uint64_t silences = 0;
      std::uint64_t faults = 0;  ///< times that one was latched, not steps spent in it
      std::uint64_t braked = 0;
      std::uint64_t starting = 0;
      std::uint64_t softened = 0;
    };

    GuardNote notes = GuardNote::none;  ///< of the last step
    Fault fault = Fault::none;
    Counts counts;
    /// Passivity ledger, J: positive energy was given to the hand. Work in the world, which is
    /// Workspace::scale times that on the hand.
    double energy = 0;
  };

  /// Larger numbers than this (N, m, m/s, N/m) are a fault: no working device makes them
  /// (judgement).
  static constexpr double kLargest = 1e9;
  /// Share of the newest velocity in the smoothed one, a step (docs/method.md 8).
  static constexpr double kSmoothing = 0.25;

  /// @throws Error when an option is out of its range.
  explicit Guard(const GuardOptions& options = {});
  ~Guard();
  Guard(Guard&&) noexcept;
  Guard& operator=(Guard&&) noexcept;

  /// The force that may go to the device, N. Finite, whatever the input.
  [[nodiscard]] Eigen::Vector3d pass(const Input& input) noexcept;

  /// Forgets a fault, or lets go of the hand: a force that acts goes to zero as if nothing were
  /// felt. Then it forgets where the hand was; the next force comes up from zero.
  void reset() noexcept;

  [[nodiscard]] const State& state() const noexcept;
  [[nodiscard]] const GuardOptions& options() const noexcept;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

/// The same guard for a hand whose motion is magnified `scale` times (Workspace::scale): in the
/// world a damper is weaker, a mass lighter and work larger by that.
[[nodiscard]] GuardOptions in_world(GuardOptions at_hand, double scale) noexcept;

/// Why the force stays at zero and what to do; empty for none.
[[nodiscard]] std::string_view in_words(Guard::Fault fault) noexcept;

/// Describes what the guard did in the last step and why, in one line; empty if nothing.
[[nodiscard]] std::string in_words(const Guard::State& state);

}  // namespace palpate
