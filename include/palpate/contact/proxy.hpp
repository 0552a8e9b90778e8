#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "palpate/contact/contact.hpp"
#include "palpate/contact/energy_tank.hpp"
#include "palpate/field/field.hpp"

namespace palpate {

class Probe;
struct Slide;
struct SurfacePoint;

/// How the proxy follows the hand along the surface.
enum class ProxyMethod {
  converged,    ///< to the closest point in every step (algorithm.md section 2)
  single_step,  ///< one tangent-plane step a tick (Salisbury and Tarr 1997; the paper)
};

/// A cone on the proxy, with a viscous term that is implicit in time (algorithm.md section 6).
struct Friction {
  double static_coefficient = 0;   ///< mu_s; at least mu_d
  double dynamic_coefficient = 0;  ///< mu_d
  double viscous = 0;              ///< b_v, N s/m
};

/// A smooth relief carved into the surface, 0 to 2 amplitudes deep: the sum of three sinusoids in
/// world coordinates along oblique, mutually orthogonal directions. Conservative, because it
/// changes the surface and not the force (algorithm.md section 6). Carved and never raised, so that
/// a ball that is free of the smooth surface is free of the relief.
struct Texture {
  double amplitude = 0;      ///< m; smooth while amplitude <= wavelength^2 / (40 depth of the hand)
  double wavelength = 4e-3;  ///< m
};

struct ProxyOptions {
  double stiffness = 500;  ///< K, N/m
  Friction friction = {};
  Texture texture = {};
  ProxyMethod method = ProxyMethod::converged;
  int max_iterations = 20;  ///< constrained sub-steps a step; 1 to 1000
  double tangent_tolerance =
      1e-3;  ///< closest-point iteration stops below this many R; 1e-6 to 0.1
};

/// The 3-DOF god-object: follows the hand through free space and stays on the surface when the
/// hand goes in (algorithm.md section 2; paper section III, after Salisbury and Tarr).
///
/// One proxy belongs to one thread. step(), change() and reset() never allocate, lock, throw or
/// call the system. Non-finite input latches a fault: zero force until reset().
class Proxy {
 public:
  /// Farther from the origin than this (m) doubles no longer resolve a surface: a fault.
  static constexpr double kLargestCoordinate = 1e9;

  /// @throws Error when an option is not finite or out of its range.
  explicit Proxy(const ProxyOptions& options = {});

  /// Moves the proxy towards the hand at `hip` (m, world). `dt` is the time since the last step
  /// (s); friction and fading use it. 0 is taken as 1 ns; a negative one is a fault.
  ///
  /// The first step after construction puts the proxy where the hand is. A field that is solid
  /// there pushes the proxy to its nearest front at once. Spends at most max_evaluations()
  /// evaluations of the field.
  [[nodiscard]] Contact step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept;

  /// Where the proxy is, m, world. The origin until the first step or reset().
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }
  [[nodiscard]] const ProxyOptions& options() const noexcept { return options_; }

  /// What a step spends at most: 1000 in sweeps (and what the last interval of one takes), 20 for
  /// each constrained sub-step allowed (and what a Newton takes), and recovery.
  [[nodiscard]] int max_evaluations() const noexcept { return 1100 + 20 * options_.max_iterations; }

  /// Feels stiffness (N/m), friction and texture like this from the next step on; in contact,
  /// stiffness goes there as EnergyTank allows. False, and nothing changes, where a number is out
  /// of its range.
  bool change(double stiffness, const Friction& friction, const Texture& texture) noexcept;

  /// Puts the proxy at `position`, in free space, and forgets contact and faults.
  void reset(const Eigen::Vector3d& position) noexcept;

 private:
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
  void let_go(Probe& probe, const Eigen::Vector3d& hip) noexcept;
  [[nodiscard]] double wanted_stiffness() const noexcept;
  [[nodiscard]] double begun_stiffness(const Eigen::Vector3d& place,
                                       const Eigen::Vector3d& hip) const noexcept;
  [[nodiscard]] double unexplained(const Eigen::Vector3d& before, const Eigen::Vector3d& hip,
                                   double dt) const noexcept;
  void take_over(const EnergyTank& before, const Eigen::Vector3d& hip, Contact& contact) noexcept;
  [[nodiscard]] Contact faulted() noexcept;

  ProxyOptions options_;
  EnergyTank tank_;
  FadingSpring fading_;  // of contacts that a change of the surface ended
  Surface surface_;      // where the proxy touches
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  // of the last contact; zero: none
  Eigen::Vector3d hand_ = Eigen::Vector3d::Zero();    // that the proxy last caught up with
  double step_length_ = 0;                            // R where it was last known, m
  double lost_time_ = 0;                              // s since the surface was lost
  std::optional<std::uint64_t> revision_;             // of the field in the last step
  bool started_ = false;
  bool touching_ = false;
  bool sliding_ = false;
  bool cut_short_ = false;  // the last step's search, by its budget
  bool fault_ = false;
};

}  // namespace palpate
