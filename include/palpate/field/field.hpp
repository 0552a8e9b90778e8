// The interface between a surface and a proxy.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// The implicit function at one position. Free where value > 0, solid where value <= 0.
struct Sample {
  double value = 0;                                    ///< length-like, m
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< d value / d x; points outward
  double support = 0;  ///< sum of weights (1 on a well sampled surface); 0: no points here
  double radius = 0;   ///< support radius R here: the length that steps are measured in, m
  /// Is it free though a surface's points lie in front of it, since that holds towards its eye
  /// alone? Then the gradient is zero.
  bool behind = false;
  /// Does the gradient face no eye that saw this surface? Then nothing rests on it.
  bool averted = false;
};

/// Properties of the surface near a position on it.
struct Surface {
  double stiffness_factor = 1;  ///< multiplies the proxy's stiffness, 0-1
  double friction_factor = 1;   ///< multiplies the proxy's friction, 0-1
  double presence = 1;          ///< 0-1: the sensor's confidence in this surface
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the surface, m/s
  int source = -1;  ///< index of the source that contributes most; -1: none
};

/// A proxy's view of a scene: an implicit surface with its exact gradient.
///
/// Every member is noexcept, allocation-free, bounded in time, and gives finite results for finite
/// arguments. A Field belongs to one thread: implementations may cache what they gathered.
class Field {
 public:
  /// Facts that hold for the whole field between two changes of it.
  struct Traits {
    double resolution = 0;       ///< sweeps look for solid chords longer than this, m
    std::uint64_t revision = 0;  ///< grows when the surface may have moved since the last tick
    double reanchor_reach = 0;   ///< how far above a proxy a surface that moved is looked for, m
    double step = 0;             ///< how far the surface may have stepped since the last tick, m; a
                                 ///< spring that it takes farther, and more than 1 m/s, ends
  };

  virtual ~Field() = default;

  /// The function at x. A surface that can be touched from both sides is as it looks from where the
  /// proxy's last step ended: it does not change while a step lasts.
  [[nodiscard]] virtual Sample sample(const Eigen::Vector3d& x) const noexcept = 0;

  /// True only if the ball certainly holds nothing solid.
  [[nodiscard]] virtual bool is_free(const Ball& ball) const noexcept = 0;

  /// The properties of the surface at x.
  [[nodiscard]] virtual Surface surface(const Eigen::Vector3d& x) const noexcept = 0;

  [[nodiscard]] virtual Traits traits() const noexcept = 0;

  /// Begins a proxy's step, which end_step() ends. The work of all calls in between is bounded
  /// together: a field that has spent it answers on the safe side: all that it has not evaluated is
  /// solid.
  virtual void begin_step() const noexcept {}
  /// Points that have been summed over since a step began: what its evaluations cost. A field that
  /// sums over none costs the same everywhere.
  [[nodiscard]] virtual int points_summed() const noexcept { return 0; }
  /// `proxy`: where it is then, m; `normal`: of the surface that it touches, zero for none.
  virtual void end_step(const Eigen::Vector3d& /*proxy*/,
                        const Eigen::Vector3d& /*normal*/) const noexcept {}

 protected:
  Field() = default;
  Field(const Field&) = default;
  Field& operator=(const Field&) = default;
};

}  // namespace palpate
