#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "palpate/servo/guard.hpp"

namespace palpate {

/// Ledger of the energy that forces gave to the hand, and brake that takes it back: passivity
/// observer and controller (Hannaford and Ryu 2002, in the impedance form; docs/method.md 8.5).
///
///   E += F . (dh - v_surface dt);   E > 0: F -= min(E / (|v|^2 dt), M / (2 n dt) - B) v
///
/// dt is the time from one reading of the hand's position to the next, dh the way in between. F
/// acted on that way; it was sent `delay` steps before the way began, and a hand that is read more
/// rarely than once a step takes forces only where it is read. Without the delay the ledger would
/// miss just the energy that a delay makes. Work that a moving surface does on the hand is its own
/// and not counted. n = max(2, delay + 1) readings: sampled and delayed dampers that are stronger
/// than about M / (n dt) together shake the hand. Half of that is safe with a mass that was guessed
/// up to twice too large. B is the damper that acts beside the brake. Real-time.
template <int kAxes>
class PassivityOf {
 public:
  using Vector = Eigen::Matrix<double, kAxes, 1>;

  static constexpr int kMaximumDelay = 16;

  /// Options in their ranges.
  explicit PassivityOf(const GuardOptions::Passivity& options) noexcept : options_(options) {
    reset();
  }

  /// A reading of the hand, `steps` after the one before. `force` (N, on the hand) was sent at the
  /// step before; over the last `dt` (s) the hand moved by `displacement` (m) against the surface.
  /// `stored` (J): energy in the stretched spring, which it
  /// will give back; never forgotten. Energy taken beyond that is forgotten with the time constant
  /// `forget`, and at once when no force acts any more: no contact pays for the next one.
  void account(const Vector& force, const Vector& displacement, double stored, double dt,
               int steps = 1) noexcept;

  /// Braking force, N, to add to `force` before it is sent, if the hand keeps moving by
  /// `displacement` (m) from reading to reading, every `dt` (s). Zero unless committed(), with
  /// `force`, is above zero. `damping`, N s/m: B of a damper that is part of `force`.
  [[nodiscard]] Vector brake(const Vector& force, const Vector& displacement, double dt,
                             double damping = 0) const noexcept;

  /// Predicted ledger, J, after the forces in the delay line have acted, if the hand keeps moving
  /// by `displacement` (m) from reading to reading.
  [[nodiscard]] double committed(const Vector& displacement) const noexcept;

  /// J; above zero: given to the hand, below: taken from it recently.
  [[nodiscard]] double energy() const noexcept { return energy_; }
  /// Strongest brake, as a damper beside another of `damping`, of a hand that is read every `dt`
  /// (s); N s/m.
  [[nodiscard]] double strongest(double dt, double damping) const noexcept;
  void reset() noexcept;

 private:
  // The last force before a reading: what a hand that is read there has got.
  struct Sent {
    Vector force = Vector::Zero();
    int steps = 1;  // that the reading before it lasted
  };

  [[nodiscard]] const Sent& sent(int readings_ago) const noexcept;
  [[nodiscard]] int acting(int steps) const noexcept;
  [[nodiscard]] bool rests() const noexcept;

  GuardOptions::Passivity options_;
  std::array<Sent, kMaximumDelay + 1> sent_;  // ring
  std::size_t newest_ = 0;
  int delay_ = 0;  // readings from a force's being sent to its effect, as they come now
  double energy_ = 0;
};

using Passivity = PassivityOf<3>;

}  // namespace palpate
