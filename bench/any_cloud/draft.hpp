#pragma once

#include <optional>
#include <vector>

#include "any_cloud/hand.hpp"
#include "any_cloud/shape.hpp"
#include "base/numbers.hpp"

namespace palpate::any_cloud {

/// A scene as a family draws it: lengths in spacings, in a frame of its own. R is expected at 2.5.
struct Draft {
  explicit Draft(std::uint64_t seed) : random(seed) {}

  Random random;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;  ///< true ones, outward; as long as `points`
  bool give_normals = false;             ///< with the cloud
  double jitter = 0.2;                   ///< of sheets, to either side, within them
  double noise = 0;                      ///< sigma along the true normals
  std::optional<Eigen::Vector3d> viewpoint;
  Shape truth;  ///< empty: nobody knows
  HandPath hand;
  int roam = 0;          ///< ticks that a hand roams around a closed body, where it would poke it
  double deep = 0.75;    ///< from this depth of the ideal contact on, contact is required
  double clear = 1.875;  ///< from this distance of the hand on, contact is forbidden

  [[nodiscard]] double between(double low, double high);
  [[nodiscard]] Eigen::Vector3d within(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  [[nodiscard]] Eigen::Vector3d direction();

  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);
  /// A jittered grid over a rectangle with its rim; along x along is outward.
  void sheet(const Eigen::Vector3d& corner, const Eigen::Vector3d& along,
             const Eigen::Vector3d& across, double step = 1);
  /// The surface of a solid as far as it lies in a box, without a grid: no two points nearer than
  /// 0.8, and nowhere room for another.
  void surface(const Shape& shape, const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// Evenly spread on a ball around the origin.
  void sphere(double radius);
};

}  // namespace palpate::any_cloud
