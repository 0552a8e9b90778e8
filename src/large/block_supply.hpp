// Declares where the blocks of a large cloud come from: memory, or a store on disk.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "large/blocks.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// A part of a cloud that is prepared by itself.
struct CloudBlock {
  enum class State : std::uint8_t { missing, failed, prepared, shown };

  Division::Key key;
  Box box;     ///< that holds its points, world frame, m
  Box region;  ///< of a store: it is needed while a tool is near this box, which holds `box`
  State state = State::missing;
  double retry = 0;     ///< of one that failed: from when on it is tried again, s
  double presence = 0;  ///< at the start of what was shown last; 1 at its end
  double distance = 0;  ///< from what tools can reach, m; negative within
  Box sparser;          ///< around points in its cube that belong to further levels, once read
  Piece piece;          ///< once it is prepared
};

/// How far a box is beyond a ball, m; negative within.
[[nodiscard]] inline double distance(const Box& box, const Ball& ball) {
  const Eigen::Vector3d nearest = ball.center.cwiseMax(box.lower).cwiseMin(box.upper);
  return (ball.center - nearest).norm() - ball.radius;
}

/// The same of the nearest of several balls; infinite without one.
[[nodiscard]] inline double distance(const Box& box, std::span<const Ball> balls) {
  double least = std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls) least = std::min(least, distance(box, ball));
  return least;
}

/// The blocks of one cloud. One thread at a time uses it.
class BlockSupply {
 public:
  virtual ~BlockSupply() = default;

  [[nodiscard]] virtual const CloudFacts& facts() const = 0;
  [[nodiscard]] virtual std::size_t points() const = 0;      ///< of all of the cloud
  [[nodiscard]] virtual Eigen::Vector3d origin() const = 0;  ///< of its surface, m
  /// Where the cloud is looked at before there are tools.
  [[nodiscard]] virtual Eigen::Vector3d start() const = 0;
  /// Points of what is not shown, thinned, world frame; null where all is.
  [[nodiscard]] virtual std::shared_ptr<const PointCloud> overview(
      std::span<const CloudBlock> blocks) const = 0;
  /// Does list() give all of the cloud?
  [[nodiscard]] virtual bool is_whole() const = 0;

  /// Adds the blocks that tools may need soon, and takes out others, farther away than `near` (m),
  /// where memory is short.
  /// @return boxes without a block: what is there is not loaded.
  [[nodiscard]] virtual std::vector<Box> list(std::span<const Ball> tools, double near,
                                              std::vector<CloudBlock>& blocks) = 0;

  /// Is there memory for a block that is not near?
  [[nodiscard]] virtual bool has_room(std::span<const CloudBlock> blocks) const = 0;

  /// @throws Error as PointStore::read() does; then the block is as it was.
  virtual void prepare(CloudBlock& block) = 0;

  /// Does prepare() prepare all of the cloud together? Then blocks serve until that is done.
  [[nodiscard]] virtual bool comes_together() const { return false; }

  /// Calls `progress` as prepare() does.
  [[nodiscard]] virtual Prepared prepare_together(const detail::Progress& /*progress*/) const {
    return {};
  }
};

/// All of a cloud in memory.
[[nodiscard]] std::unique_ptr<BlockSupply> blocks_of(std::shared_ptr<const PointCloud> cloud,
                                                     const PrepareOptions& options,
                                                     const Eigen::Isometry3d& T_world_sensor);

/// What lies around tools of a store, in at most so many bytes of `memory`.
[[nodiscard]] std::unique_ptr<BlockSupply> blocks_of(const std::shared_ptr<const PointStore>& store,
                                                     const PrepareOptions& options,
                                                     const Eigen::Isometry3d& T_world_sensor,
                                                     std::size_t memory);

}  // namespace palpate
