// A tool that a hand holds in the place of a point.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "palpate/servo/servo.hpp"
#include "palpate/tool/tool_field.hpp"
#include "palpate/tool/tool_proxy.hpp"

namespace palpate {

/// Renders a scene to a hand that holds a tool and feels forces, but no torques. Real-time but for
/// construction.
class HeldTool {
 public:
  /// `limit`: of the stiffness, N/m.
  /// @throws Error as ToolField and ToolProxy do, and where steps are to be traced.
  HeldTool(Scene& scene, const ServoOptions& options, double limit);

  /// A step to `hand` at `now` (s), `dt` (s) after the last one: what a point would report, at the
  /// handle. The drift is the velocity along the force that the wrist's turning has the surface
  /// push the handle with: a wrist without motors does that work, which is no gift to the hand
  /// (docs/method.md 3.7).
  [[nodiscard]] Contact step(double now, const Pose& hand, double dt) noexcept;
  void reset(const Pose& hand) noexcept;
  void change(double stiffness, const Friction& friction) noexcept {
    proxy_.change(stiffness, friction);
  }
  void change(const FieldOptions& checked) noexcept { field_.change(checked); }

  [[nodiscard]] const Pose& pose() const noexcept { return proxy_.pose(); }
  [[nodiscard]] const Wrench& wrench() const noexcept { return wrench_; }
  [[nodiscard]] FieldNote notes() const noexcept { return field_.notes(); }

 private:
  [[nodiscard]] Eigen::Vector3d drift(const Pose& hand, double dt) const noexcept;

  ToolField field_;
  ToolProxy proxy_;
  Pose hand_;  // in the last step
  Wrench wrench_;
  bool started_ = false;
};

}  // namespace palpate
