#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "depth/block_grid.hpp"
#include "depth/temporal_memory.hpp"

namespace palpate::depth {

/// Puts what is remembered of blocks into the view of a camera that has moved: each block's piece
/// of plane into the blocks of the new view that its middle falls next to. The nearer of two
/// surfaces hides the other one; of one surface, the piece whose middle is nearest is taken. It
/// is then cut with the new block's ray, bent as its neighbours say.
class TemporalWarp {
 public:
  /// Takes memory when there are more blocks than ever, and no more.
  void resize(std::size_t blocks);

  /// `T_now_before` takes coordinates of the old sensor frame to the new one's.
  void warp(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
            std::vector<BlockMemory>& memory);

 private:
  /// The piece that a block of the new view has been given.
  struct Claim {
    std::int32_t from = -1;  // block of the old view
    float rho = 0;           // of the piece's middle, in the new view
    float dc = 0;            // from the block to the piece's middle, in blocks
    float dr = 0;
  };

  void claim(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
             const std::vector<BlockMemory>& memory);
  void offer_around(const BlockGrid& grid, std::int32_t from, float rho, float c, float r);
  void offer(const Claim& claim, std::size_t block);
  [[nodiscard]] bool put(const BlockGrid& grid, const std::vector<BlockMemory>& memory,
                         const Claim& claim, float x, float y, BlockMemory& to) const;

  std::vector<Claim> claims_;
  std::vector<Eigen::Vector3f> planes_;  // of the old view's blocks, in the new view
  std::vector<BlockMemory> warped_;
};

}  // namespace palpate::depth
