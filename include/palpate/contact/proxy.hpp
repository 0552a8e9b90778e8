#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "palpate/contact/contact.hpp"
#include "palpate/field/field.hpp"

namespace palpate {

/// How the proxy follows the hand along the surface.
enum class ProxyMethod {
  converged,    ///< to the closest point in every step (algorithm.md section 2)
  single_step,  ///< one tangent-plane step a tick (Salisbury and Tarr 1997; the paper)
};

struct Friction {
  double static_coefficient = 0;   ///< mu_s; at least mu_d
  double dynamic_coefficient = 0;  ///< mu_d
  double viscous = 0;              ///< b_v, N s/m
};

/// A smooth relief, subtracted as a height from the surface: conservative (algorithm.md section 6).
struct Texture {
  double amplitude = 0;     ///< m; smooth while amplitude <= wavelength^2 / (40 depth)
  double wavelength = 4e-3; ///< m
};

struct ProxyOptions {
  double stiffness = 500;  ///< K, N/m
  Friction friction;
  Texture texture;
  ProxyMethod method = ProxyMethod::converged;
  int max_iterations = 20;
};

/// The 3-DOF god-object: follows the hand through free space and stays on the surface when the
/// hand goes in (algorithm.md section 2; paper section III, after Salisbury and Tarr).
///
/// One proxy belongs to one thread. step() and reset() never allocate, lock, throw or call the
/// system. Non-finite input latches a fault: zero force until reset().
class Proxy {
 public:
  /// @throws Error when an option is not finite or out of its range.
  explicit Proxy(const ProxyOptions& options = {});

  /// Moves the proxy towards the hand at `hip` (m, world). `dt` is the time since the last
  /// step (s, > 0); friction and fading use it.
  [[nodiscard]] Contact step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept;

  /// Where the proxy is, m, world. The hand's first place, until the first step.
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return position_; }
  [[nodiscard]] const ProxyOptions& options() const noexcept { return options_; }

  /// Puts the proxy at `position`, in free space, and forgets contact, side and faults.
  void reset(const Eigen::Vector3d& position) noexcept;

 private:
  ProxyOptions options_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
};

}  // namespace palpate
