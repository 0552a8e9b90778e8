#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "depth/block_plane.hpp"
#include "palpate/geometry/pinhole.hpp"

namespace palpate::detail {

struct TemporalOptions {
  int memory = 8;        ///< frames that a still block averages, 1 to 255; 1: none
  double gate = 5;       ///< G: standard deviations within which a block stands still; 7 for c > 2
  bool predict = false;  ///< moving blocks are put one frame ahead
  int hold = 10;         ///< frames for which a block that is not measured any more is kept
};

/// What the filter says of one block.
enum class BlockTrack : std::uint8_t {
  none,    ///< nothing measured, nothing remembered
  still,   ///< measured; the mean of up to `memory` frames
  moving,  ///< measured; this frame's value, put ahead if that is wished
  held,    ///< not measured in this frame; as it was before
};

/// The filter over time of nss_fast.md section 3, after the fit, a block at a time. All of it is
/// bounded work without allocation once resize() has been called.
class TemporalFilter {
 public:
  /// Makes room for columns x rows blocks and forgets everything.
  void resize(int columns, int rows);
  void reset() noexcept;

  /// Moves what is remembered into the view of a camera that has moved since the last filter():
  /// each block's piece of plane is put into the block where the new view shows it, the nearer of
  /// two first. `T_now_before` takes the old sensor frame's coordinates to the new one's; `blocks`
  /// is the camera in units of blocks.
  void warp(const Eigen::Isometry3d& T_now_before, const Pinhole& blocks) noexcept;

  /// Takes in one frame, one measurement a block (unknown where there is none).
  /// `coarse`: 1 for blocks that are not fitted; empty: all are fitted. A block whose measurement
  /// changes from coarse to fitted or back starts anew without counting as another surface.
  void filter(std::span<const BlockPlane> measured, std::span<const std::uint8_t> coarse,
              const TemporalOptions& options) noexcept;

  /// A frame that repeats the one before: nothing has moved, nothing has jumped.
  void repeat() noexcept;

  /// Of the last frame, one entry a block. Unknown where the track is none.
  [[nodiscard]] std::span<const BlockPlane> planes() const { return out_; }
  [[nodiscard]] std::span<const BlockTrack> tracks() const { return tracks_; }
  /// 1: another surface than in the frame before, or the first one.
  [[nodiscard]] std::span<const std::uint8_t> jumped() const { return jumped_; }
  /// Frames since the block was last measured.
  [[nodiscard]] std::span<const std::uint8_t> missed() const { return missed_; }

 private:
  /// What is remembered of a block.
  struct Memory {
    BlockPlane plane;
    float speed = 0;         ///< v: change of rho, 1/m per frame
    std::uint8_t count = 0;  ///< frames in the mean; 0: nothing is remembered
    std::uint8_t calm = 0;   ///< frames in a row that a moving block stood still
    std::uint8_t missed = 0;
    bool moving = false;
    bool coarse = false;
  };

  int columns_ = 0;
  int rows_ = 0;
  std::vector<Memory> memory_;
  std::vector<Memory> warped_;
  std::vector<BlockPlane> out_;
  std::vector<BlockTrack> tracks_;
  std::vector<std::uint8_t> jumped_;
  std::vector<std::uint8_t> missed_;
};

}  // namespace palpate::detail
