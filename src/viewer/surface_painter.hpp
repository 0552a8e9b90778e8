#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "palpate/scene/scene_field.hpp"
#include "palpate/servo/servo.hpp"
#include "viewer/outbox.hpp"

namespace palpate::viewer {

/// What is around one tool.
struct PaintedSurface {
  double radius = 0;  ///< R, m; 0: not known
  SharedBytes bytes;  ///< the newest; null: the servo made no step yet
};

/// Meshes the surface around a servo's proxy, by a field of its own. One thread uses it, and not
/// the servo's.
class SurfacePainter {
 public:
  /// @throws Error when the scene has no place for one more field.
  SurfacePainter(Scene& scene, const Servo& servo, std::size_t device,
                 const Eigen::Vector3d& origin);

  [[nodiscard]] PaintedSurface paint();

 private:
  void follow();
  [[nodiscard]] bool worth_it(const ServoState& state, double radius);

  const Servo& servo_;
  std::uint8_t device_;
  Eigen::Vector3d origin_;
  FieldOptions options_;  // of the field
  SceneField field_;
  Eigen::Vector3d painted_at_ = Eigen::Vector3d::Zero();
  std::uint64_t painted_revision_ = 0;
  bool painted_ = false;
  SharedBytes newest_;
};

}  // namespace palpate::viewer
