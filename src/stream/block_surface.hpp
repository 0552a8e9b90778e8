#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/shapes.hpp"
#include "stream/block_faces.hpp"
#include "stream/block_rims.hpp"
#include "stream/hidden_planes.hpp"
#include "stream/padded_blocks.hpp"

namespace palpate {

/// How far the points of a depth frame reach and what they weigh, from the image alone, which
/// gives the neighbours without a search.
class BlockSurface {
 public:
  /// Two frames or neighbours of one surface differ by at most this many deviations of a block
  /// (derived: about 5 sqrt(2), five deviations of the difference).
  static constexpr float kDeviations = 7;

  /// `minimum_radius`: no R below this, m.
  explicit BlockSurface(Kernel kernel, double minimum_radius = 0)
      : kernel_(kernel),
        minimum_radius_(static_cast<float>(minimum_radius)),
        rims_(kernel_, minimum_radius_),
        hidden_(kernel_) {}

  /// Radii and areas of all blocks. Beside rims and holes a weight is exact inside the balls
  /// (sensor frame), elsewhere that of a whole surface. Allocates when the size of frames changes.
  void measure(const FilteredDepth& depth, std::span<const Ball> exact_within);
  /// The same, exact everywhere.
  void measure(const FilteredDepth& depth);

  /// R_i, m: the largest of 2.5 s, 2.2 times the largest spacing of rows, the minimum, and four
  /// deviations of the point or half a wave of the noise, whichever is less; limited so that it
  /// grows by half the distance at most from block to block; 0 where there is no point.
  [[nodiscard]] float radius(std::size_t block) const { return radii_[block]; }

  /// a_i R_i^2, m^2: the density weight of a point with radius R is this over R^2.
  [[nodiscard]] float area(std::size_t block) const { return areas_[block]; }

  /// Trust in a fitted point, 0-1: its precision over that of the blocks around it which may
  /// show the same surface, as in a mean of measurements that are not equally good.
  [[nodiscard]] float trust(std::size_t block) const { return trusts_[block]; }

  /// The planes that go on behind what hides them.
  [[nodiscard]] const HiddenPlanes& hidden() const { return hidden_; }

  // The same of all blocks.
  [[nodiscard]] const std::vector<float>& radii() const { return radii_; }
  [[nodiscard]] const std::vector<float>& areas() const { return areas_; }
  [[nodiscard]] const std::vector<float>& trusts() const { return trusts_; }

 private:
  void measure(const FilteredDepth& depth, std::span<const Ball> balls, BlockRims::Exact exact);
  void start(const FilteredDepth& depth, int v, int first, int count);
  void limit_radii(const FilteredDepth& depth);
  void find_steep(const FilteredDepth& depth, int v);
  void carry(const FilteredDepth& depth, std::ptrdiff_t sign);
  void lay_out(const FilteredDepth& depth, int v, int first, int count);
  void measure_trust(const FilteredDepth& depth, int v, int first, int count);

  Kernel kernel_;
  float minimum_radius_;
  std::vector<float> radii_;  // 0: no point
  std::vector<float> areas_;
  std::vector<float> trusts_;
  std::vector<std::uint8_t> steep_;  // of four blocks each: may a neighbour limit one of them?
  std::size_t fours_ = 0;            // in a row
  PaddedBlocks padded_;
  BlockRims rims_;
  HiddenPlanes hidden_;
};

/// Finds where the faces of a fitted depth image meet, and gives each block beside an edge or a
/// crease the plane of a block of the other face: the one that lies to the edge as it does itself,
/// so that planes of many blocks are used.
class EdgeFinder {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no edge

  /// `surface` has measured `depth`. Allocates only to grow.
  void look(const FilteredDepth& depth, const BlockSurface& surface);

  /// The number for plane() of the edge beside a block; kNone: there is none.
  [[nodiscard]] std::uint32_t number(std::size_t block) const { return of_block_[block]; }

  /// The plane beyond an edge, in the sensor's frame.
  [[nodiscard]] const SurfacePoints::EdgePlane& plane(std::uint32_t number) const {
    return found_[number].plane;
  }

 private:
  /// Two blocks of a row or column whose faces meet between them.
  struct Meeting {
    std::size_t a, b;
    Eigen::Vector3f edge;  // a point on it, m
    bool in_row;
    float share;

    [[nodiscard]] Meeting from_b() const { return {b, a, edge, in_row, share}; }
  };
  struct Found {
    SurfacePoints::EdgePlane plane;
    float away;  // squared, of the block from where its faces meet, m^2
  };

  void look_at(const BlockFaces& faces, int v);
  [[nodiscard]] static bool meets(const BlockFaces& faces, std::size_t a, int x, int y);
  void write_some(const BlockFaces& faces, std::size_t u, std::size_t v, int x, int y);
  void write(const BlockFaces& faces, std::size_t block, std::size_t apart, int x, int y);
  [[nodiscard]] static Meeting meeting_of(const BlockFaces& faces, std::size_t a, int x, int y);
  void spread(const BlockFaces& faces, const Meeting& meeting, int x, int y);
  void write_one(const BlockFaces& faces, const Meeting& meeting, int x, int y);

  std::vector<std::uint8_t> meets_;      // of each block, with one to its right or below it;
                                         // behind them some that are read and not written
  std::vector<std::uint32_t> of_block_;  // number(): the block's own, or kNone
  std::vector<Found> found_;             // of each block
};

}  // namespace palpate
