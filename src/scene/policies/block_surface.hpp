#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/parallel.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// How far the points of a depth frame reach and what they weigh, from the image alone: neighbours
/// are known without a search.
class BlockSurface {
 public:
  /// Two frames or neighbours of one surface differ by at most this many deviations of a block
  /// (derived: about 5 sqrt(2), five deviations of the difference).
  static constexpr float kDeviations = 7;

  /// `minimum_radius`: no R below this, m.
  explicit BlockSurface(Kernel kernel, double minimum_radius = 0)
      : kernel_(kernel), minimum_radius_(static_cast<float>(minimum_radius)) {}

  /// Radii and areas of all blocks. Beside rims and holes a weight is exact inside the balls
  /// (sensor frame), elsewhere that of a whole surface. Allocates when the size of frames changes.
  void measure(const FilteredDepth& depth, std::span<const Ball> exact_within);
  /// The same, exact everywhere.
  void measure(const FilteredDepth& depth);

  /// R_i, m: max(2.5 s, 2.2 times the largest spacing of rows) and no less than the minimum,
  /// limited so that it grows by half the distance at most from block to block; 0 where there is no
  /// point.
  [[nodiscard]] float radius(std::size_t block) const { return radii_[block]; }

  /// a_i R_i^2, m^2: the density weight of a point with radius R is this over R^2.
  [[nodiscard]] float area(std::size_t block) const { return areas_[block]; }

  /// Trust in a fitted point, 0-1: its precision over that of the blocks around it which may
  /// show the same surface, as in a mean of measurements that are not equally good.
  [[nodiscard]] float trust(std::size_t block) const { return trusts_[block]; }

  // The same of all blocks.
  [[nodiscard]] const std::vector<float>& radii() const { return radii_; }
  [[nodiscard]] const std::vector<float>& areas() const { return areas_; }
  [[nodiscard]] const std::vector<float>& trusts() const { return trusts_; }
  void prefetch(std::size_t block) const {
    __builtin_prefetch(&radii_[block]);
    __builtin_prefetch(&areas_[block]);
    __builtin_prefetch(&trusts_[block]);
  }

 private:
  static constexpr int kLargestWindow = 8;  // blocks on either side

  enum class Exact { nowhere, within, everywhere };

  template <class Visit>
  static void each_row(const FilteredDepth& depth, const Visit& visit) {
    constexpr std::size_t kRowsAtATime = 8;  // judgement: shares work among threads
    detail::parallel_each(static_cast<std::size_t>(depth.rows), kRowsAtATime,
                          [&](std::size_t v) { visit(v); });
  }

  void measure(const FilteredDepth& depth, std::span<const Ball> balls, Exact exact);
  void start(const FilteredDepth& depth);
  void limit_growth(const FilteredDepth& depth);
  void carry(const FilteredDepth& depth, std::ptrdiff_t sign);
  void mark_rims(const FilteredDepth& depth);
  [[nodiscard]] int half_window(const FilteredDepth& depth, std::size_t block) const;
  [[nodiscard]] bool near_rim(const FilteredDepth& depth, std::size_t block, int half) const;
  void list_rims(const FilteredDepth& depth, std::span<const Ball> balls, Exact exact);
  void make_room(const FilteredDepth& depth, int margin);
  void lay_out_places(const FilteredDepth& depth, std::size_t v);
  void lay_out(const FilteredDepth& depth, std::size_t v);
  void trust_row(const FilteredDepth& depth, std::size_t v);
  template <class Take>
  void sum_around(const FilteredDepth& depth, const float* factors, const Take& take);
  void weigh_rims(const FilteredDepth& depth);

  Kernel kernel_;
  float minimum_radius_;
  std::vector<float> radii_;  // 0: no point
  std::vector<float> areas_;
  std::vector<float> trusts_;
  std::vector<std::int32_t> rims_;  // blocks without or beside another surface, summed up to each
  std::vector<std::int32_t>
      halves_;                   // of windows whose sums are taken from neighbours; 0: none are
  std::vector<int> row_halves_;  // the largest of each row
  int largest_half_ = 0;

  // The rest has a margin of nothing all around, so that neighbours are there without asking.
  [[nodiscard]] std::size_t place(int u, int v) const {
    return static_cast<std::size_t>(v + margin_) * stride_ + static_cast<std::size_t>(u + margin_);
  }
  int margin_ = 0;
  std::size_t stride_ = 0;
  std::vector<float> x_, y_, z_;   // m
  std::vector<float> reaches_;     // in depth, of what may be the same surface, m
  std::vector<float> per_r2_;      // 1 / R^2, 1/m^2
  std::vector<float> precisions_;  // 1/m^2; 0: no point
  std::vector<float> sums_;        // S_i
  std::vector<float> ones_;
};

/// Finds where the faces of a fitted depth image meet, and tells each block beside an edge or a
/// crease the plane of a block of the other face: the one that lies to the edge as it does itself,
/// so that planes of many blocks take part.
class EdgeFinder {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no edge

  /// `surface` has measured `depth`. Allocates only to grow.
  void look(const FilteredDepth& depth, const BlockSurface& surface);

  /// The number of the edge beside a block; kNone: there is none.
  [[nodiscard]] std::uint32_t number(std::size_t block) const { return of_block_[block]; }

  void prefetch(std::size_t block) const { __builtin_prefetch(&of_block_[block]); }

  /// The plane beyond an edge, in the sensor's frame.
  [[nodiscard]] const SurfacePoints::EdgePlane& plane(std::uint32_t number) const {
    return told_[number].plane;
  }

 private:
  struct Faces;
  /// Two blocks of a row or column whose faces meet between them.
  struct Meeting {
    std::size_t a, b;
    Eigen::Vector3f edge;  // a place on it, m
    bool in_row;
    float share;
  };
  struct Told {
    SurfacePoints::EdgePlane plane;
    std::size_t block;
    float away;  // squared, of the block from where its faces meet, m^2
  };

  void look_at(const Faces& faces, int v);
  [[nodiscard]] static bool meets(const Faces& faces, std::size_t a, int x, int y);
  void join(const Faces& faces, std::size_t a, int x, int y);
  void spread(const Faces& faces, const Meeting& meeting);
  void tell(const Faces& faces, const Meeting& meeting, int x, int y);

  std::vector<std::uint8_t> meets_;  // of each block, with one to its right or below it
  std::vector<std::uint32_t> of_block_;
  std::vector<Told> told_;
};

}  // namespace palpate
