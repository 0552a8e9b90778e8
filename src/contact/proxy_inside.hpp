#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "contact/probe.hpp"
#include "contact/slide.hpp"
#include "contact/way_out.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate {

/// Lets the stiffness of a contact change without ever giving energy to the hand.
///
/// A spring of stiffness K stretched by d holds K d^2 / 2. When K rises by dK during contact,
/// dK d^2 / 2 is created from nothing and the hand gets it back on its way out: a ramp of 30 ms was
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

  /// Takes in what a FadingSpring gave up, J.
  void fill(double energy) noexcept;

  /// Moves the stiffness towards `wanted` (N/m) over a step of `dt` (s) in which the spring is
  /// stretched by `stretch` (m) and friction took `dissipated` (J, >= 0). Returns the new
  /// stiffness. Finite for finite arguments; never above max(wanted, what it was).
  double follow(double wanted, double stretch, double dissipated, double dt) noexcept;

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
  /// Takes over a spring from `place` (m) of this stiffness (N/m). Two springs pull like one.
  void take(const Eigen::Vector3d& place, double stiffness) noexcept;

  /// A step of `dt` (s) with the hand at `hip` (m). Returns the energy that it gave up, J.
  double fade(const Eigen::Vector3d& hip, double dt) noexcept;

  [[nodiscard]] Eigen::Vector3d force(const Eigen::Vector3d& hip) const noexcept {
    return stiffness_ * (place_ - hip);
  }
  [[nodiscard]] double stiffness() const noexcept { return stiffness_; }  ///< N/m

 private:
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  double stiffness_ = 0;
  double gone_ = 0;  // stiffness at which it ends
};

/// What a proxy does and what it keeps from step to step. Real-time.
class Proxy::Inside {
 public:
  /// Checked options.
  explicit Inside(const ProxyOptions& options) : options_(options) {}

  [[nodiscard]] Contact step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept;
  void reset(const Eigen::Vector3d& position) noexcept;

  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }
  [[nodiscard]] const ProxyOptions& options() const noexcept { return options_; }
  void change(const ProxyOptions& checked) noexcept { options_ = checked; }

 private:
  static constexpr double kKeepLost = 0.02;  // s, for which the spring of a lost contact stays
  static constexpr double kAwayTime = 1;  // s in free air, after which a hand is let go (judgement)

  struct Times {
    double lost = 0;  // s since the surface was lost
    double away = 0;  // s that the hand has been in free air, far from the proxy
  };

  /// What the budget left of the last step's search.
  struct Search {
    bool cut_short = false;
    int looked = 0;  // places that recover() has looked at
  };

  [[nodiscard]] bool is_held() const noexcept { return touching_ && !waiting_; }
  void follow(Probe& probe, const Eigen::Vector3d& hip, Contact& contact) noexcept;
  void touch(Probe& probe, const Eigen::Vector3d& place, const Eigen::Vector3d& hip) noexcept;
  void release(const Eigen::Vector3d& place) noexcept;
  void hold(Probe& probe, const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;
  [[nodiscard]] std::optional<SurfacePoint> find_surface(Probe& probe, const Eigen::Vector3d& hip,
                                                         Contact& contact) noexcept;
  [[nodiscard]] bool settle(const Slide& motion, Contact& contact) noexcept;
  void pull(const Eigen::Vector3d& hip, double dissipated, double dt, Contact& contact) noexcept;
  void keep(Probe& probe, const Eigen::Vector3d& hip, double dt, Contact& contact) noexcept;
  void cut_short(Contact& contact) noexcept;
  void await(Probe& probe, const Eigen::Vector3d& place, const Eigen::Vector3d& normal,
             const Eigen::Vector3d& pressed, const Eigen::Vector3d& hip) noexcept;
  void let_go(Probe& probe, const Eigen::Vector3d& hip) noexcept;
  void free_hand(Probe& probe, const Eigen::Vector3d& before, const Eigen::Vector3d& hip, double dt,
                 Contact& contact, bool changed) noexcept;
  [[nodiscard]] double wanted_stiffness() const noexcept;
  [[nodiscard]] double initial_stiffness(const Eigen::Vector3d& place,
                                         const Eigen::Vector3d& hip) const noexcept;
  [[nodiscard]] double unexplained_jump(const Eigen::Vector3d& before, const Eigen::Vector3d& hip,
                                        double dt) const noexcept;
  void take_over(const EnergyTank& before, const Eigen::Vector3d& hip, Contact& contact) noexcept;
  [[nodiscard]] Contact faulted() noexcept;

  ProxyOptions options_;
  EnergyTank tank_;
  FadingSpring fading_;  // of contacts that a change of the surface ended
  WayOut way_out_;       // of a static scene
  Surface surface_;      // where the proxy touches
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();   // of the last contact; zero: none
  Eigen::Vector3d hand_ = Eigen::Vector3d::Zero();     // that the proxy last caught up with
  Eigen::Vector3d pressed_ = Eigen::Vector3d::Zero();  // the hand, when its surface vanished
  double step_length_ = 0;                             // R where it was last known, m
  Times since_;
  Search search_;
  std::optional<std::uint64_t> revision_;  // of the field in the last step
  bool started_ = false;
  bool touching_ = false;
  bool sliding_ = false;
  bool waiting_ = false;  // for a surface that has vanished
  bool fault_ = false;
};

}  // namespace palpate
