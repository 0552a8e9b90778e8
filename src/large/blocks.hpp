// Blocks of a large cloud, each prepared by itself of its own points and those around it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "large/division.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"

namespace palpate {

/// Can blocks be prepared each by itself? Not where a step needs the values of all points.
[[nodiscard]] bool can_go_by_blocks(const PrepareOptions& options);

/// Is a cloud of so many points prepared in blocks? A large one is, and one whose facts are given.
[[nodiscard]] bool goes_by_blocks(std::size_t points, const PrepareOptions& options);

/// What came of one block: columns of its own points alone, which are not indexed yet.
struct Piece {
  std::vector<Eigen::Vector3f> positions;  ///< m, in the frame of the cloud
  SurfacePoints columns;                   ///< without a grid
  Prepared::Report report;                 ///< of the block's own points
};

/// The blocks of a cloud. What a block becomes depends on the facts, on its own points and on those
/// that lie near, so it is the same whenever and with whatever others it is prepared; segments and
/// components end at its faces. All but construction may be called by several threads.
class Blocks {
 public:
  /// Measures the facts where the options give none. `placed` has to outlive it. `halvings`: of the
  /// edges of the blocks.
  Blocks(const Placed& placed, const PrepareOptions& options, int halvings = 0);

  [[nodiscard]] const CloudFacts& facts() const { return facts_; }
  [[nodiscard]] std::size_t size() const { return division_.size(); }
  [[nodiscard]] const Division& division() const { return division_; }

  /// How far around that points count for it, m.
  [[nodiscard]] double halo(std::size_t block) const;

  [[nodiscard]] Piece prepare(std::size_t block, const detail::Progress& progress = {}) const;
  [[nodiscard]] std::vector<Piece> prepare_all(const detail::Progress& progress = {}) const;

 private:
  const PointCloud& cloud_;
  PrepareOptions options_;  // of one block
  std::optional<Eigen::Vector3d> viewpoint_;
  CloudFacts facts_;
  Division division_;
};

/// One surface of some blocks of a cloud with that origin, indexed. Points have the same order
/// whichever other blocks are there.
[[nodiscard]] Prepared join(std::span<const Piece* const> pieces, const CloudFacts& facts,
                            const Eigen::Vector3d& origin, Kernel kernel);

/// The same, and frees each piece once it is in.
[[nodiscard]] Prepared join(std::vector<Piece> pieces, const CloudFacts& facts,
                            const Eigen::Vector3d& origin, Kernel kernel);

}  // namespace palpate
