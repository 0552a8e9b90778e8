#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "palpate/contact/proxy.hpp"

namespace palpate {

/// Lets the stiffness of a contact change without ever giving energy to the hand.
///
/// A spring of stiffness K stretched by d holds K d^2 / 2. When K rises by dK during contact,
/// dK d^2 / 2 is created from nothing and the hand gets it back as it leaves: a ramp of 30 ms was
/// measured to turn a rebound of 1.05 into 1.49 (docs/method.md 3.5). So a rise is paid for out
/// of a tank, and only what a fall of K or sliding friction took away goes into it. A fall costs
/// nothing; it takes kTime only to spare the hand a step of force. Rises take that time as well.
///
/// While the wanted stiffness stays what it is, the tank changes nothing, bit for bit.
class EnergyTank {
 public:
  static constexpr double kCapacity = 0.02;  ///< J; what was dissipated long ago hides nothing
  static constexpr double kTime = 0.02;      ///< s, in which K falls to 1/e, or rises by itself

  /// A new contact begins with an empty tank and this stiffness (N/m).
  void restart(double stiffness) noexcept;

  /// A spring of this stiffness (N/m) takes over from one that ended: the tank stays as full.
  void take_over(double stiffness) noexcept { stiffness_ = stiffness; }

  /// Takes in energy, J, up to kCapacity.
  void fill(double energy) noexcept;

  /// Moves the stiffness towards `wanted` (N/m) over a step of `dt` (s) in which the spring is
  /// stretched by `stretch` (m) and friction took `dissipated` (J, >= 0). Returns the new
  /// stiffness. Finite for finite arguments; never above max(wanted, what it was).
  double follow(double wanted, double stretch, double dissipated, double dt) noexcept;

  /// Raises the stiffness by the share `risen` of `wanted` (N/m), up to it, and nothing pays.
  void give(double wanted, double risen) noexcept;

  [[nodiscard]] double stiffness() const noexcept { return stiffness_; }  ///< N/m
  [[nodiscard]] double energy() const noexcept { return energy_; }        ///< J in the tank

 private:
  void fall(double wanted, double half_square, double dt) noexcept;
  void rise(double wanted, double half_square, double dt) noexcept;

  double stiffness_ = 0;
  double energy_ = 0;
};

/// What is left of springs that ended though no hand let them go: it stays where they were and
/// loses its stiffness as a contact does, in EnergyTank::kTime. Rests at 0 N/m.
class FadingSpring {
 public:
  /// Takes over a spring from `anchor` (m) of this stiffness (N/m). Two springs pull like one.
  void take(const Eigen::Vector3d& anchor, double stiffness) noexcept;

  /// A step of `dt` (s) with the hand at `hip` (m). Returns the energy that it gave up, J.
  double fade(const Eigen::Vector3d& hip, double dt) noexcept;

  [[nodiscard]] Eigen::Vector3d force(const Eigen::Vector3d& hip) const noexcept {
    return stiffness_ * (anchor_ - hip);
  }
  [[nodiscard]] double stiffness() const noexcept { return stiffness_; }  ///< N/m

 private:
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  double stiffness_ = 0;
  double gone_ = 0;  // stiffness at which it ends
};

/// Lets go of a hand that is held hard in free air for long: its spring fades, then it is free.
class AwayClock {
 public:
  /// `away`: it is held so in this step of `dt` (s), too. True: it is to be let go.
  bool count(bool away, double dt) noexcept {
    away_ = away ? away_ + dt : 0;
    return away_ >= kAwayTime;
  }
  /// The share of its stiffness that a spring has left.
  [[nodiscard]] double left() const noexcept {
    return std::clamp(1 - (away_ - kAwayTime) / kFreeing, 0.0, 1.0);
  }

 private:
  static constexpr double kAwayTime = 1;   // s, after which a hand is let go (judgement)
  static constexpr double kFreeing = 0.5;  // s, in which its spring fades (judgement)

  double away_ = 0;  // s that the hand has been held so
};

/// The spring between proxy and hand: a tank pays for its stiffness, what earlier contacts left
/// fades beside it, and two clocks take it away where nothing should hold the hand. Real-time.
class Spring {
 public:
  /// The proxy was put elsewhere.
  void reset() noexcept { *this = {}; }

  /// The proxy moves freely, or a contact begins: both clocks stand at 0.
  void rest() noexcept {
    lost_ = 0;
    away_ = {};
  }

  /// The contact's surface was found in this step.
  void find() noexcept { lost_ = 0; }
  /// It has not been found for `dt` (s) more.
  void lose(double dt) noexcept { lost_ += dt; }
  [[nodiscard]] bool is_lost() const noexcept { return lost_ > kKeepLost; }

  /// AwayClock::count()
  [[nodiscard]] bool hold_away(bool away, double dt) noexcept { return away_.count(away, dt); }

  /// The stiffness (N/m) that a contact comes to whose surface allows `full`.
  [[nodiscard]] double wanted(double full) const noexcept;

  /// A new contact begins with this stiffness (N/m).
  void begin(double stiffness) noexcept { tank_.restart(stiffness); }

  /// A contact goes on with the tank that `before` was and this stiffness (N/m), stretched by
  /// `stretch` (m) from hand to proxy. What a spring that was left gives up while it fades pays for
  /// the stiffness that this one lacks of what `full` allows.
  void go_on(const EnergyTank& before, double stiffness, double full,
             const Eigen::Vector3d& stretch, Contact& contact) noexcept;

  /// A contact waits without force; its tank keeps what the spring held.
  void wait(const Eigen::Vector3d& stretch) noexcept;

  /// A contact ended at `anchor` (m) though no hand let it go: its spring (N/m) fades there.
  void leave(const Eigen::Vector3d& anchor, double stiffness) noexcept {
    fading_.take(anchor, stiffness);
  }

  /// Time of a step.
  struct Step {
    double dt;     // s
    double risen;  // share of the stiffness that comes though nothing pays for it
  };
  /// A step in which friction took `dissipated` (J).
  void pull(double full, const Eigen::Vector3d& stretch, double dissipated, Step step,
            Contact& contact) noexcept;

  /// Adds what earlier contacts left to this step's contact.
  void add_fading(const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;

  [[nodiscard]] const EnergyTank& tank() const noexcept { return tank_; }
  [[nodiscard]] double stiffness() const noexcept { return tank_.stiffness(); }  ///< N/m

 private:
  static constexpr double kKeepLost = 0.02;  // s, for which the spring of a lost contact stays

  void pull(double full, const Eigen::Vector3d& stretch, Contact& contact) const noexcept;

  EnergyTank tank_;
  FadingSpring fading_;  // of contacts that a change of the surface ended
  double lost_ = 0;      // s since the surface was lost
  AwayClock away_;
};

}  // namespace palpate
