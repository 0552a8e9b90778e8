// Coulomb friction where the samples of a tool press on a surface.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "contact/probe.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "tool/active_set.hpp"

namespace palpate {

/// Friction's law at every contact of a step (docs/method.md 4.1): each holds the tool back by a
/// stretch of the spring along the surface, up to what its cone allows. Real-time.
class ToolFriction {
 public:
  /// A step begins at this pose. `law`: of all contacts; without one nothing is held.
  void begin(const FrictionLaw& law, const Pose& pose) noexcept {
    law_ = law;
    start_ = pose;
    stuck_ = slides_ ? 0 : std::min(stuck_ + 1, kSettled);
    slid_ = stuck_ < kSettled;
  }
  /// The tool is free: a new contact begins at rest.
  void forget() noexcept {
    contacts_.count = 0;
    slides_ = slid_ = false;
    stuck_ = kSettled;
  }
  [[nodiscard]] bool any() const noexcept { return law_.any(); }

  using Along = Eigen::Vector2d;

  /// A constraint that presses, as the last look found it.
  struct Contact {
    int sample = -1;                            ///< -1: of no surface
    Eigen::Matrix<double, 3, 2> axes;           ///< along the surface, unit
    Eigen::Matrix<double, kFreedoms, 2> along;  ///< how motions move it along them
    Along moved = Along::Zero();                ///< in the step before that look, m
    Along held = Along::Zero();                 ///< stretch, m
    Motion normal = Motion::Zero();
    double bound = 0;
    double pressed = 0;  ///< multiplier of the normal, m
    double weight = 1;   ///< bounds the eigenvalues of along^T along
  };

  /// What a tool tries to do in one look.
  struct Look {
    const Tool& tool;
    const Metric& metric;
    const Pose& pose;
    std::span<const Constraint> constraints;
    Motion wanted;  ///< from the pose to the hand
  };
  /// The wanted motion with what friction holds of it. Contacts are those of `least`, the motion
  /// without friction, and those of the look before that are still near.
  [[nodiscard]] Motion hold(const Look& look, const LeastMotion& least) noexcept;
  /// Adds what presses in `least`, the motion with friction, which tips a tool. False: it is known.
  [[nodiscard]] bool add(const Look& look, const LeastMotion& least) noexcept;
  /// hold() with the contacts that are there.
  [[nodiscard]] Motion hold_again(const Look& look) noexcept;

  [[nodiscard]] std::span<const Contact> contacts() const noexcept { return contacts_.span(); }
  /// J that a step which ends at this pose took from a spring with the law's stiffness.
  [[nodiscard]] double dissipated(const Metric& metric, const Pose& end) const noexcept;
  /// Did a contact slide in this step?
  [[nodiscard]] bool slides() const noexcept { return slides_; }

 private:
  // Steps without sliding after which a tool is at rest: what the sweeps leave open lets one that
  // slides stick for a few.
  static constexpr int kSettled = 20;

  // At most as many as can be told of.
  struct Contacts {
    std::array<Contact, ToolContact::kMostTouches> all;
    std::size_t count = 0;

    [[nodiscard]] std::span<Contact> span() noexcept { return std::span(all).first(count); }
    [[nodiscard]] std::span<const Contact> span() const noexcept {
      return std::span(all).first(count);
    }
    [[nodiscard]] const Contact* of(int sample) const noexcept;
    void append(const Contact& contact) noexcept {
      if (count < all.size()) all[count++] = contact;
    }
  };

  [[nodiscard]] Contact contact_of(const Look& look, const Constraint& constraint) const noexcept;
  [[nodiscard]] bool relax(double coefficient, int sweeps, Motion& motion) noexcept;
  [[nodiscard]] double press(Contact& contact, Motion& motion) const noexcept;
  [[nodiscard]] double rub(Contact& contact, double coefficient, Motion& motion) const noexcept;
  [[nodiscard]] Along slip_of(const Contact& contact, const Motion& motion) const noexcept;

  FrictionLaw law_;
  Pose start_;
  Contacts contacts_;
  bool slides_ = false;
  bool slid_ = false;  // not long ago, or in a look of this step
  int stuck_ = kSettled;
};

}  // namespace palpate
