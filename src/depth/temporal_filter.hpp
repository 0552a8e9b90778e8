#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "depth/blocks.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// Memory of one block in the filter over time; see BlockFits for the columns.
struct BlockMemory {
  float rho = 0;             ///< mean inverse depth, 1/m
  float variance = 0;        ///< of one frame's rho, 1/m^2: of the mean it is variance / count
  float extra = 0;           ///< variance that moving into other views has added, 1/m^2
  float slope_x = 0;         ///< 1/m
  float slope_y = 0;         ///< 1/m
  float slope_variance = 0;  ///< of one frame's slopes, 1/m^2
  float confidence = 0;
  float calm_since = 0;     ///< rho of the last frame that was not calm, 1/m
  float last[3] = {};       ///< rho, slope_x and slope_y of the last frame, 1/m
  float moves[3] = {};      ///< from the frame before to the last, 1/m
  float scatter = 0;        ///< variance of one frame's rho that the frames themselves show, 1/m^2
  float slope_scatter = 0;  ///< the same of its slopes
  std::uint8_t count = 0;   ///< frames in the mean; 0: nothing is remembered
  std::uint8_t calm = 0;    ///< frames in a row that a moving block stood still
  std::uint8_t missed = 0;
  bool moving = false;
  FilteredDepth::State state = FilteredDepth::State::empty;
};

/// A change of inverse depth beyond this is another surface, not one that moves: 30 mm, what a
/// hand's 1 m/s covers in a frame.
[[nodiscard]] inline float another_surface(float rho) {
  return 0.03F * rho * rho;
}

/// Puts the memory of blocks into the view of a camera that has moved: each block's piece of plane
/// into the blocks of the new view that its middle falls next to. The nearer of two surfaces hides
/// the other one; of one surface, the piece whose middle is nearest is taken. It is then cut with
/// the new block's ray, bent as its neighbours are.
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

struct TemporalOptions {
  int memory = 8;           ///< frames that a still block averages, 1 to 255; 1: none
  double gate = 5;          ///< G: standard deviations within which a block stands still
  double normal_error = 0;  ///< wanted of normals, rad: blocks that are less precise average up to
                            ///< eight times as many frames; 0: all alike
  int hold = 10;            ///< frames for which a block that is not measured is remembered
};

/// Options that suit a sensor: G = 5, or 7 if many pixels err together (c > 4), since the variances
/// of fits are less certain then (docs/method.md 6.6).
[[nodiscard]] TemporalOptions temporal_options(int memory, double correlation, double normal_error);

/// Filters each block over time, after the fit: averages what stands still, takes what moves as it
/// is measured. Bounded work; it allocates only when the grid's size changes.
class TemporalFilter {
 public:
  /// Before the rows of a frame. `T_world_sensor` is the pose at the stamp; if it has changed, the
  /// memory is put into the new view.
  /// @return is the view that of the frame before?
  bool begin(const BlockGrid& grid, const Eigen::Isometry3d& T_world_sensor);

  /// Takes in some blocks of a row and replaces their columns by the filtered ones; several
  /// threads may take different rows. Empty blocks stay empty, but are remembered for
  /// TemporalOptions::hold frames, and continue if they are measured by then. A block whose state
  /// changes between plain and fitted starts again.
  /// `settled`: returns for each whether its mean has as many frames as it will have.
  void filter(const TemporalOptions& options, int row, int first, int count, BlockFits& fits,
              std::uint8_t* settled);

  void reset();

  /// Memory of each block; seen `missed` frames ago if that is not 0.
  [[nodiscard]] std::span<const BlockMemory> memory() const { return memory_; }

 private:
  BlockGrid grid_;
  Eigen::Isometry3d T_world_sensor_ = Eigen::Isometry3d::Identity();
  std::vector<BlockMemory> memory_;
  TemporalWarp warp_;
};

}  // namespace palpate::depth
