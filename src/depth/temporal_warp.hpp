#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "depth/block_grid.hpp"
#include "depth/temporal_memory.hpp"

namespace palpate::depth {

/// Puts what is remembered of blocks into the view of a camera that has moved: each block's piece
/// of plane into the blocks of the new view that its middle falls next to. The nearer of two
/// surfaces hides the other one; of one surface, the piece whose middle is nearest is taken. Its
/// plane is then cut with the new block's ray.
class TemporalWarp {
 public:
  /// Takes memory when there are more blocks than ever, and no more.
  void resize(std::size_t blocks);

  /// `T_now_before` takes coordinates of the old sensor frame to the new one's. `expected` gets
  /// the inverse depth at which each block's ray now meets the plane that the block showed before;
  /// 0: it showed nothing, or the ray misses it.
  void warp(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
            std::vector<BlockMemory>& memory, std::vector<float>& expected);

 private:
  /// The piece that a block of the new view has been given.
  struct Claim {
    std::int32_t from = -1;  // block of the old view
    float rho = 0;           // of the piece's middle, in the new view
    float offset2 = 0;       // of its middle from the block's, in blocks
  };

  void claim(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
             const std::vector<BlockMemory>& memory);
  void offer(const Claim& claim, std::size_t block);

  std::vector<Claim> claims_;
  std::vector<BlockMemory> warped_;
};

}  // namespace palpate::depth
