// Declares what the blocks of a depth frame show.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/shapes.hpp"
#include "stream/block_order.hpp"
#include "stream/block_surface.hpp"
#include "stream/moving_points.hpp"

namespace palpate {

/// The point that a frame shows at an index of the curve; R = 0: none.
struct alignas(64) SeenPoint {
  PointState state;
  float area = 0;  ///< a_i R_i^2
  float trust = 1;
  float variance = 0;  ///< along the ray, m^2
  std::uint32_t index = 0;
  std::uint32_t edge = EdgeFinder::kNone;  ///< the finder's

  /// The least cosine of the angle between the normals of one surface before and after a frame: 60
  /// degrees (judgement; docs/method.md 7.3).
  static constexpr float kTurns = 0.5f;

  [[nodiscard]] float weight(float radius) const {
    return trust * std::min(1.0f, area / (radius * radius));
  }

  /// How far a surface has gone along its normal when it was at `from`, m: what a block shows of
  /// it goes farther along the ray.
  [[nodiscard]] float advance_from(const Eigen::Vector3f& from) const;

  /// Does a surface that faced along `normal` face elsewhere now? One whose normal is unknown does
  /// not.
  [[nodiscard]] bool turns_from(const Eigen::Vector3f& normal) const {
    return !normal.isZero(0) && state.normal.dot(normal) < kTurns * state.normal.squaredNorm();
  }
};

/// The same of four blocks that follow one another.
struct SeenFour {
  Vectors position, normal;
  Floats radius, confidence, area, trust, variance;
  Ints edges;
  std::uint32_t index;  ///< the first

  [[nodiscard]] SeenPoint lane(int l) const;
};

/// What each block of a filtered depth frame shows, along the curve and relative to the points'
/// origin.
class FrameBlocks {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no block

  /// Share of the blocks around one that have to show what moves: most (judgement).
  static constexpr float kVouchToMove = 0.6f;

  explicit FrameBlocks(Kernel kernel, double minimum_radius) : surface_(kernel, minimum_radius) {}

  /// Measures a frame, which stays until the next: exactly inside the balls (world frame), or
  /// everywhere. Allocates only to grow.
  void look(const FilteredDepth& depth, std::span<const Ball> reach, bool everywhere);

  /// Puts the frame where its camera is. `streams`: more than one frame has come, so points weigh
  /// by their trust. Returns whether blocks see elsewhere than those of the frame before.
  bool put(const FilteredDepth& depth, const Eigen::Vector3d& origin, bool streams);

  [[nodiscard]] const BlockOrder& order() const { return order_; }

  /// Does the frame show at four blocks what the frame before showed?
  [[nodiscard]] bool keeps(std::size_t index) const {
    const std::size_t last = std::min(index + kLanes, order_.size()) - 1;
    // Four blocks are in two tiles at most, but for the last ones of the image's corner.
    return kept_[order_.codes[index] / kInTile] != 0 && kept_[order_.codes[last] / kInTile] != 0;
  }

  /// What four blocks show that follow one another; the last index stands for those beyond it.
  [[nodiscard]] SeenFour four_at(std::size_t index) const;

  /// Does a plane go on behind one of four blocks?
  [[nodiscard]] bool hide(std::size_t index) const { return hide_[index / kLanes] != 0; }

  /// The point of a plane that goes on behind what the block at an index shows; R = 0: none does.
  [[nodiscard]] SeenPoint behind(std::uint32_t index) const;

  /// The share of blocks around one that show the same surface: what flies between two has few.
  [[nodiscard]] float vouching(std::size_t index) const;

  /// Along the camera's axis, m.
  [[nodiscard]] float depth_of(const Eigen::Vector3f& position) const {
    return turn_.col(2).dot(position - shift_);
  }

  /// The index of the block that sees a position; kNone: outside the image.
  [[nodiscard]] std::uint32_t index_of(const Eigen::Vector3f& position,
                                       const Pinhole& pinhole) const;

  /// The edge beside a point that the frame shows, in the world frame.
  [[nodiscard]] SurfacePoints::EdgePlane edge_of(const SeenPoint& seen) const;

 private:
  static constexpr std::uint32_t kInTile = KeptTiles::kSide * KeptTiles::kSide;  // blocks

  void note_kept(const KeptTiles& kept);
  void note_hidden();

  BlockOrder order_;
  BlockSurface surface_;
  EdgeFinder edges_;
  std::vector<Ball> local_reach_;
  const FilteredDepth* depth_ = nullptr;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix3f turn_ = Eigen::Matrix3f::Identity();  // sensor to world
  Eigen::Vector3f shift_ = Eigen::Vector3f::Zero();
  std::vector<std::uint8_t> kept_;  // of tiles along the curve
  std::vector<std::uint8_t> hide_;  // of four blocks each
  bool streams_ = false;
  bool resized_ = false;  // the image, since the frame before was put
};

}  // namespace palpate
