// Holes in a segment: empty discs that its points surround.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Finds the hole beside one point after another; keeps its memory in between.
class HoleFinder {
 public:
  HoleFinder();

  /// The radius (m) of the widest empty disc in the plane through point i that has the point on its
  /// rim and others all around it; 0: there is none of more than `least` and at most `largest`.
  /// `near`: points within `least`; where these fill the plane, as they mostly do, none is looked
  /// for. `around`: all within twice `least`, and any others. `normal`: the plane's, unit. Points
  /// more than 45 degrees off the plane belong to other segments; one that is nearer than the hole
  /// is wide hides it. What a segment's border is open to is no hole.
  [[nodiscard]] float radius_beside(const CellGrid& grid, std::uint32_t i,
                                    std::span<const std::uint32_t> near,
                                    std::span<const std::uint32_t> around,
                                    const Eigen::Vector3f& normal, float least, float largest);

 private:
  // Directions, 15 degrees apart, that are looked in first: a hole that is seen between two of them
  // alone is missed; judgement.
  static constexpr int kDirections = 24;
  using Directions = Eigen::Array<float, kDirections, 1>;

  /// Is each position `radius` (m) off the point nearer to one of `near`?
  [[nodiscard]] bool is_filled(const CellGrid& grid, std::uint32_t i,
                               std::span<const std::uint32_t> near, float radius) const;
  /// Do points lie around the empty disc with this middle?
  [[nodiscard]] bool is_surrounded(const Eigen::Vector2f& middle);
  void start(const Eigen::Vector3f& normal, float reach);
  void cut(const CellGrid& grid, std::uint32_t i, std::span<const std::uint32_t> near);
  void cut(const Eigen::Vector2f& other, float half);

  Directions cosines_;
  Directions sines_;
  Eigen::Vector3f u_ = {};  // along the plane
  Eigen::Vector3f v_ = {};
  std::vector<std::uint32_t> near_;
  std::vector<Eigen::Vector2f> others_;  // from the point, m; so are corners
  std::vector<Eigen::Vector2f> cell_;    // what is nearer to the point than to any other
  std::vector<Eigen::Vector2f> kept_;
  std::vector<float> angles_;  // of what lies around a disc, rad
  float squared_ = 0;          // distance to the farthest corner, m^2
};

}  // namespace palpate
