#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "depth/blocks.hpp"
#include "depth/temporal_warp.hpp"

namespace palpate::depth {

struct TemporalOptions {
  int memory = 8;           ///< frames that a still block averages, 1 to 255; 1: none
  double gate = 5;          ///< G: standard deviations within which a block stands still
  double normal_error = 0;  ///< wanted of normals, rad: blocks that are less sure average up to
                            ///< eight times as many frames; 0: all alike
  int hold = 10;            ///< frames for which a block that is not measured is remembered
};

/// What suits a sensor: G = 5, and 7 where pixels err together (c > 2), since the variances of fits
/// tell less then.
[[nodiscard]] TemporalOptions temporal_options(int memory, double correlation, double normal_error);

/// The filter over time, after the fit, a block at a time: what stands
/// still is averaged, what moves is taken as it is measured. Bounded work; it allocates only when
/// the grid's size changes.
class TemporalFilter {
 public:
  /// Takes in one frame and replaces its columns by the filtered ones. Blocks that are empty stay
  /// so; that nothing confirms them is for others to deal with. What was known of them is
  /// remembered for a while and goes on when they are measured again. `T_world_sensor` is the pose
  /// at the stamp: when it is another than before, what is remembered is put into the new view
  /// first. A block whose state changes between plain and fitted starts again.
  void filter(const TemporalOptions& options, const Eigen::Isometry3d& T_world_sensor,
              BlockFits& fits);

  void reset();

  /// What is remembered, an entry a block; `missed` frames ago where that is not 0.
  [[nodiscard]] std::span<const BlockMemory> memory() const { return memory_; }

 private:
  void prepare(const BlockGrid& grid, const Eigen::Isometry3d& T_world_sensor);

  BlockGrid grid_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
  std::vector<BlockMemory> memory_;
  TemporalWarp warp_;
};

}  // namespace palpate::depth
