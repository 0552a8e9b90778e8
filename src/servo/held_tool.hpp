// A tool that a hand holds in the place of a point.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "palpate/servo/servo.hpp"
#include "palpate/tool/tool_field.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "servo/wrench_guard.hpp"

namespace palpate {

/// Renders a scene to a hand that holds a tool, and feels torque and grip where its device renders
/// them. Real-time but for construction.
class HeldTool {
 public:
  /// `options`: fitted to the device; `limit`: of the stiffness, N/m.
  /// @throws Error as ToolField and ToolProxy do.
  HeldTool(Scene& scene, const ServoOptions& options, const DeviceInfo& device, double limit);

  /// A step to `hand` at `now` (s), `dt` (s) after the last one: what a point would report, at the
  /// handle. The drift is the velocity along the force that turning a wrist without motors has the
  /// surface push the handle with, and the same of fingers: the wrist does that work, which is no
  /// gift to the hand (docs/method.md 3.7).
  [[nodiscard]] Contact step(double now, const Pose& hand, double dt) noexcept;
  void reset(const Pose& hand) noexcept;
  void change(const ProxyOptions& point) noexcept {
    proxy_.change(point.stiffness, point.friction, point.texture);
  }
  void change(const FieldOptions& checked) noexcept { field_.change(checked); }

  [[nodiscard]] const Pose& pose() const noexcept { return proxy_.pose(); }
  [[nodiscard]] const Wrench& wrench() const noexcept { return wrench_; }
  [[nodiscard]] SceneField::Found found() const noexcept { return field_.found(); }
  [[nodiscard]] FieldNote notes() const noexcept { return field_.notes(); }

  /// Does the hand feel more than a force? Then this guards its steps.
  [[nodiscard]] bool is_felt_turning() const noexcept { return guard_.has_value(); }
  /// What of the last step may go to the device, world. `touching`: the wrench counts; `hand`: as
  /// it is without the clutch; `velocity`: of its turns, rad/s.
  [[nodiscard]] Wrench guarded(const Guard::Input& input, bool touching, const Pose& hand,
                               const Eigen::Vector3d& velocity) noexcept {
    return guard_->pass(input, {touching ? wrench_ : Wrench(), hand, velocity});
  }
  [[nodiscard]] const Guard::State& guard_state() const noexcept { return guard_->state(); }

 private:
  [[nodiscard]] Eigen::Vector3d drift(const Pose& hand, double dt) const noexcept;

  ToolField field_;
  ToolProxy proxy_;
  std::optional<WrenchGuard> guard_;
  Pose hand_;  // in the last step
  Wrench wrench_;
  bool started_ = false;
};

}  // namespace palpate
