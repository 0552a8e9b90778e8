#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/surface_points.hpp"
#include "scene/policies/block_surface.hpp"

namespace palpate {

/// Finds where the faces of a fitted depth image meet, and tells each block beside an edge or a
/// crease the plane of a block of the other face: the one that lies to the edge as it does itself,
/// so that planes of many blocks take part.
class EdgeFinder {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// `surface` has measured `depth`. Allocates only to grow.
  void look(const FilteredDepth& depth, const BlockSurface& surface);

  /// Of the edge that a block lies beside; kNone: of none.
  [[nodiscard]] std::uint32_t number(std::size_t block) const { return of_block_[block]; }

  void prefetch(std::size_t block) const { __builtin_prefetch(&of_block_[block]); }

  /// Of an edge, in the sensor's frame.
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
