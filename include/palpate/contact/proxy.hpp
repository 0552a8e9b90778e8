#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>

#include "palpate/field/field.hpp"

namespace palpate {

/// Things that a proxy reports of a step, as bits.
enum class ContactNote : std::uint32_t {
  none = 0,
  sweep_truncated = 1u << 0,  ///< the hand moved too far for one step; the sweep goes on next step
  lost = 1u << 1,             ///< no surface could be found near the proxy; the force fades
  not_converged = 1u << 2,    ///< the step's iterations ran out before the closest point
  reanchored = 1u << 3,       ///< the surface moved over the proxy and took it along
  fault = 1u << 4,            ///< an input was not finite: zero force until reset()
  softer = 1u << 5,  ///< stiffness is much below what is wanted: the energy tank lets it grow
                     ///< only as motion pays for it
  fell =
      1u << 6,  ///< what held the proxy yielded: it went, in contact or out of it, farther than
                ///< twice the hand's displacement and the surface's by half of |proxy - HIP| before
  freed = 1u << 7,   ///< the hand was held in free air, and the proxy came to it: at once where the
                     ///< proxy had passed through a surface and is trapped behind it; with more
                     ///< than 10 N and 10 R from the proxy after 1 s, in 0.5 s; a tool that turns
                     ///< also where it was held so inside of something, wherever the hand was
  inside = 1u << 8,  ///< a tool that turns was put, or let go, inside of a surface or across it: it
                     ///< touches nothing until it has been outside
};

[[nodiscard]] constexpr ContactNote operator|(ContactNote a, ContactNote b) noexcept {
  return static_cast<ContactNote>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr ContactNote& operator|=(ContactNote& a, ContactNote b) noexcept {
  return a = a | b;
}
[[nodiscard]] constexpr bool has(ContactNote notes, ContactNote bit) noexcept {
  return (static_cast<std::uint32_t>(notes) & static_cast<std::uint32_t>(bit)) != 0;
}

/// What one proxy step gives.
struct Contact {
  /// On the hand, N, world: K (proxy - HIP), and what is left of springs that a change of the
  /// surface ended.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();   ///< m, world
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward unit normal; 0 when not touching
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();   ///< velocity of the touched surface, m/s
  double stiffness = 0;                              ///< of all springs in the force, N/m
  bool touching = false;  ///< held by a surface; not while it waits for one that vanished
  bool sliding = false;   ///< friction yielded in this step
  int iterations = 0;     ///< constrained sub-steps taken
  int evaluations = 0;    ///< field samples and ball tests spent
  int source = -1;        ///< index of the touched source; -1: none
  ContactNote notes = ContactNote::none;
};

/// A cone on the proxy, with a viscous term that is implicit in time (docs/method.md 4.1).
struct Friction {
  double static_coefficient = 0;   ///< mu_s; at least mu_d
  double dynamic_coefficient = 0;  ///< mu_d
  double viscous = 0;              ///< b_v, N s/m
};

/// A smooth relief carved into the surface, 0 to 2 amplitudes deep: the sum of three sinusoids in
/// world coordinates along oblique, mutually orthogonal directions. Conservative, because it
/// changes the surface and not the force (docs/method.md 4.2). Carved and never raised, so that
/// a ball that is free of the smooth surface is free of the relief.
struct Texture {
  double amplitude = 0;      ///< m; smooth while amplitude <= wavelength^2 / (40 depth of the hand)
  double wavelength = 4e-3;  ///< m
};

struct ProxyOptions {
  /// How the proxy follows the hand along the surface.
  enum class Method {
    converged,    ///< to the closest point in every step (docs/method.md 3.3)
    single_step,  ///< one tangent-plane step a tick (Salisbury and Tarr 1997; the paper)
  };

  double stiffness = 500;  ///< K, N/m
  Friction friction = {};
  Texture texture = {};
  Method method = Method::converged;
  int max_iterations = 20;  ///< constrained sub-steps a step; 1 to 1000
  double tangent_tolerance =
      1e-3;  ///< closest-point iteration stops below this many R; 1e-6 to 0.1
  /// s in which a softened contact comes to its stiffness though no motion of the hand pays for it;
  /// above 0. Infinite: it gives a hand no energy (docs/method.md 3.5). Finite: for hands that no
  /// motor moves; these feel a surface that fades with all of its stiffness until it is gone.
  double rise_time = std::numeric_limits<double>::infinity();
};

/// The 3-DOF god-object: follows the hand through free space and stays on the surface when the
/// hand goes in (docs/method.md 3; paper section III, after Salisbury and Tarr).
///
/// One proxy belongs to one thread. step(), change() and reset() never allocate, lock, throw or
/// call the system. Non-finite input latches a fault: zero force until reset().
class Proxy {
 public:
  /// Farther from the origin than this (m) doubles no longer resolve a surface: a fault.
  static constexpr double kLargestCoordinate = 1e9;

  /// @throws Error when an option is not finite or out of its range.
  explicit Proxy(const ProxyOptions& options = {});
  ~Proxy();
  Proxy(Proxy&&) noexcept;
  Proxy& operator=(Proxy&&) noexcept;

  /// Moves the proxy towards the hand at `hip` (m, world). `dt` is the time since the last step
  /// (s); friction and fading use it. 0 is taken as 1 ns; a negative one is a fault.
  ///
  /// The first step after construction puts the proxy where the hand is. A field that is solid
  /// there pushes the proxy to its nearest front at once, with the full stiffness: Guard softens
  /// that. The surface of a cloud, but for a metaball, is not solid there: its outside is where the
  /// hand begins, but for surfaces within 0.1 R whose outside is known, which keep it. Spends at
  /// most max_evaluations() evaluations of the field.
  [[nodiscard]] Contact step(const Field& field, const Eigen::Vector3d& hip, double dt) noexcept;

  /// Is the proxy somewhere? It is nowhere until the first step or reset(), and while a fault
  /// lasts.
  [[nodiscard]] bool has_begun() const noexcept;
  /// Where the proxy is, m, world. Before it has begun it is the origin, which says nothing.
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept;
  [[nodiscard]] const ProxyOptions& options() const noexcept;

  /// What a step spends at most: 1000 in sweeps (and what the last interval of one takes), 20 for
  /// each constrained sub-step allowed (and what a Newton takes), recovery, and 16 looks for an
  /// escape.
  [[nodiscard]] int max_evaluations() const noexcept;

  /// Sets stiffness (N/m), friction and texture from the next step on; in contact,
  /// stiffness goes there as the energy tank allows (docs/method.md 3.5). False, and nothing
  /// changes, where a number is out of its range.
  bool change(double stiffness, const Friction& friction, const Texture& texture) noexcept;

  /// Puts the proxy at `position` and forgets contact and faults. Where that is in a solid, the
  /// next step does as the first one.
  void reset(const Eigen::Vector3d& position) noexcept;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
