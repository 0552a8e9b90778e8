#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace palpate {

/// Things that a proxy reports of a step, as bits.
enum class ContactNote : std::uint32_t {
  none = 0,
  sweep_truncated = 1u << 0,  ///< the hand moved too far for one step; the sweep goes on next step
  lost = 1u << 1,             ///< no surface could be found near the proxy; the force fades
  not_converged = 1u << 2,    ///< the step's iterations ran out before the closest point
  reanchored = 1u << 3,       ///< the surface moved over the proxy and took it along
  fault = 1u << 4,            ///< an input was not finite: zero force until reset()
  softer = 1u << 5,           ///< stiffness is much below what is wanted: EnergyTank lets it grow
                              ///< only as motion pays for it
  fell = 1u << 6,  ///< what held the proxy gave way: it went, in contact or out of it, farther than
                   ///< twice the hand's way and the surface's by half of |proxy - HIP| before
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
  bool touching = false;
  bool sliding = false;  ///< friction gave way in this step
  int iterations = 0;    ///< constrained sub-steps taken
  int evaluations = 0;   ///< field samples and ball tests spent
  int source = -1;       ///< index of the touched source; -1: none
  ContactNote notes = ContactNote::none;
};

}  // namespace palpate
