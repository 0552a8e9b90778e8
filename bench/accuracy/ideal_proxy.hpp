#pragma once

#include <Eigen/Core>

#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {

/// The frictionless god-object on the exact solids (Zilles and Salisbury 1995): the place that a
/// point reaches which is pulled to the hand and may not enter anything. It goes in steps of
/// 0.05 mm, between which all solids count as their tangent half-spaces; these lie outside convex
/// solids, so that nothing is ever crossed.
class IdealProxy {
 public:
  IdealProxy(const TruthScene& scene, const Eigen::Vector3d& start);

  /// Follows the hand in a straight line to `hip` (m) and comes to rest.
  void follow(const Eigen::Vector3d& hip);

  [[nodiscard]] const Eigen::Vector3d& position() const { return position_; }

 private:
  void settle(const Eigen::Vector3d& hip);

  const TruthScene* scene_;
  Eigen::Vector3d position_;
  Eigen::Vector3d hip_;
};

}  // namespace palpate::accuracy
