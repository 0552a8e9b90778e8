// The spring between a tool and the hand that holds it, in the metric of its motions.
#pragma once

#include "contact/spring.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "tool/motion.hpp"

namespace palpate {

/// The spring of docs/method.md 3.5 for poses: a tank pays for stiffness that grows, and a spring
/// that a change of the surface ended fades where it was.
class ToolSpring {
 public:
  /// Forgets contact and what fades.
  void reset() noexcept { *this = {}; }

  /// What a step means to the spring.
  struct Step {
    Pose hand;
    Pose before;       ///< the tool's pose before the step
    Pose now;          ///< and after it
    double full = 0;   ///< stiffness that the surface allows, N/m
    double moved = 0;  ///< length of the hand's motion in the metric, m, and what is open beyond it
    double dissipated = 0;  ///< by friction, J
    double dt = 0;          ///< s
    bool touching = false;  ///< a surface holds the tool now
    bool jumped = false;    ///< a change of the surface took the tool along farther than it may
  };
  /// Sets wrench, stiffness, touching and ContactNote::softer.
  void pull(const Step& step, const Metric& metric, ToolContact& contact) noexcept;

  /// AwayClock::count()
  [[nodiscard]] bool hold_away(bool away, double dt) noexcept { return away_.count(away, dt); }

  /// Did a surface hold the tool in the last step?
  [[nodiscard]] bool touching() const noexcept { return touching_; }
  /// N/m, without what fades.
  [[nodiscard]] double stiffness() const noexcept { return touching_ ? tank_.stiffness() : 0; }

 private:
  void leave(const Step& step, const Metric& metric) noexcept;
  void add_fading(const Step& step, const Metric& metric, ToolContact& contact) noexcept;

  EnergyTank tank_;
  AwayClock away_;
  Pose anchor_;            // of what fades
  double fading_ = 0;      // its stiffness, N/m
  double gone_ = 0;        // stiffness at which it ends, N/m
  bool touching_ = false;  // in the last step
};

}  // namespace palpate
