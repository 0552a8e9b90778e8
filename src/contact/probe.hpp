#pragma once

#include <Eigen/Core>
#include <optional>

#include "palpate/contact/proxy.hpp"
#include "palpate/field/field.hpp"

namespace palpate {

/// Friction in one step, as lengths of the spring between proxy and hand: what a force is, divided
/// by K (docs/method.md 4.1).
struct FrictionLaw {
  double static_coefficient = 0;
  double dynamic_coefficient = 0;
  double viscous_rate = 0;  ///< b_v / dt, N/m
  double stiffness = 0;     ///< K, N/m

  [[nodiscard]] bool any() const noexcept { return static_coefficient > 0 || viscous_rate > 0; }
};

/// `factor` scales all three coefficients.
[[nodiscard]] FrictionLaw friction_law(const Friction& friction, double factor, double stiffness,
                                       double dt) noexcept;

/// Does the surface hold the proxy, when the spring is stretched by `normal` into the surface and
/// by `tangential` along it (m)?
[[nodiscard]] bool sticks(const FrictionLaw& law, bool sliding, double normal,
                          double tangential) noexcept;

/// The stretch along the surface that remains after the proxy has slid as far as friction lets it,
/// m, in [0, tangential]. `moved`: what it has slid in this step already, m.
[[nodiscard]] double held_stretch(const FrictionLaw& law, double normal, double tangential,
                                  double moved) noexcept;

/// The height that a texture adds to the surface and its gradient; the height is never above 0.
struct Relief {
  double height = 0;  ///< m, in [-2 amplitude, 0]
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// The relief at x (m, world).
[[nodiscard]] Relief relief_at(const Texture& texture, const Eigen::Vector3d& x) noexcept;

/// Carves the relief at x (m, world) into a sample of a field there.
void carve(const Texture& texture, const Eigen::Vector3d& x, Sample& sample) noexcept;

/// Points that an evaluation costs as much as to sum over, besides those that it does sum over.
inline constexpr int kEvaluationWork = 32;

/// A field as the proxy sees it during one step: with its relief, and counted.
class Probe {
 public:
  Probe(const Field& field, const Texture& texture, double radius) noexcept;
  ~Probe() = default;
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) noexcept;
  [[nodiscard]] bool is_free(const Ball& ball) noexcept;
  [[nodiscard]] bool inside(const Eigen::Vector3d& x) noexcept { return !(sample(x).value > 0); }

  [[nodiscard]] const Field& field() const noexcept { return field_; }
  [[nodiscard]] const Field::Traits& traits() const noexcept { return traits_; }

  /// The support radius R where it was last sampled, m: what steps are measured in.
  [[nodiscard]] double radius() const noexcept { return radius_; }
  [[nodiscard]] int evaluations() const noexcept { return evaluations_; }

  /// What has been spent, in points summed over: what a step's budgets are in.
  [[nodiscard]] int work() const noexcept {
    return kEvaluationWork * evaluations_ + field_.points_summed();
  }

  int swept = 0;  ///< work that sweeps have spent

 private:
  const Field& field_;
  const Texture& texture_;
  Field::Traits traits_;
  double radius_;
  int evaluations_ = 0;
};

/// A position on the surface.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< outward, unit
  double radius = 0;                                   ///< R here, m
};

/// Does a sample that is not free say so only because there are no points here?
[[nodiscard]] constexpr bool is_nothing(double value, double support) noexcept {
  return support <= 0 && value <= 0;
}

/// The first-order signed distance phi = f / |grad f| at a sample; empty where there is no surface
/// to speak of.
[[nodiscard]] std::optional<double> first_order_distance(const Sample& sample) noexcept;

/// Brings x onto the surface along the gradient (docs/method.md 3.2): at most 11 samples. A
/// last step below 2e-4 R is taken without another sample: what it leaves is of the order of its
/// square, about 4e-8 R, and the normal is that of the position before it.
[[nodiscard]] std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x) noexcept;

/// The same where the first sample is taken already: at most 10 more.
[[nodiscard]] std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x,
                                                  const Sample& first) noexcept;

/// The most that all sweeps of one step spend, in Probe::work() (docs/method.md 3.6).
inline constexpr int kSweepWork = 1000 * kEvaluationWork;

/// How a free position lies to a surface near it that holds towards its eye alone.
enum class Standing {
  front,   ///< not behind it
  behind,  ///< behind it, where it is solid for its eye
  within,  ///< in its solid front half, which was entered from behind
};

/// Where the path from one position to another ends.
struct Sweep {
  enum class End {
    clear,      ///< free all along
    hit,        ///< something solid: `position` is the last free position before it
    truncated,  ///< the step's budget ran out: free as far as `position`
  };
  End end = End::clear;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d solid = Eigen::Vector3d::Zero();     ///< the solid position of a hit, m
  Standing standing = Standing::front;                 ///< of its end
};

/// Brings the end of a hit onto the surface: from its free position or, where that is behind a
/// surface that holds towards the other side alone and has no gradient, from the solid one.
[[nodiscard]] std::optional<SurfacePoint> land(Probe& probe, const Sweep& hit) noexcept;

/// One ball around the whole path: true if it is certainly free.
[[nodiscard]] bool path_is_free(Probe& probe, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to) noexcept;

/// First contact on the path (docs/method.md 3.1): bisection into balls that are free for certain
/// and leaves shorter than the field's resolution, whose ends are sampled. No solid chord longer
/// than the resolution is missed. `from` is taken to be free.
///
/// What holds towards its eye alone stops nobody who comes out of it from behind: a path that
/// enters it where the field rises passes, until it is free again. `standing`: of where it begins.
[[nodiscard]] Sweep sweep(Probe& probe, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                          Standing standing = Standing::front) noexcept;

/// path_is_free(), and sweep() if it is not.
[[nodiscard]] Sweep first_contact(Probe& probe, const Eigen::Vector3d& from,
                                  const Eigen::Vector3d& to) noexcept;

}  // namespace palpate
