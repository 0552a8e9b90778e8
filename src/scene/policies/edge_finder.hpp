#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/depth/filtered_depth.hpp"
#include "palpate/field/surface_points.hpp"
#include "scene/policies/block_surface.hpp"

namespace palpate {

/// Finds where the faces of a fitted depth image meet, and tells each block beside an edge or a
/// crease the plane of a block of the other face: the one that lies to the edge as it does itself,
/// so that planes of many blocks take part.
class EdgeFinder {
 public:
  /// `surface` has measured `depth`. Allocates only to grow.
  void look(const FilteredDepth& depth, const BlockSurface& surface);

  /// Of a block, in the sensor's frame; share 0: it lies beside no edge.
  [[nodiscard]] const EdgePlane& edge(std::size_t block) const { return edges_[block]; }

 private:
  struct Faces;
  /// Two blocks of a row or column whose faces meet between them.
  struct Meeting {
    std::size_t a, b;
    Eigen::Vector3f edge;  // a place on it, m
    bool in_row;
    float share;
  };

  void join(const Faces& faces, std::size_t a, int x, int y);
  void spread(const Faces& faces, const Meeting& meeting);
  void tell(const Faces& faces, const Meeting& meeting, int x, int y);

  std::vector<EdgePlane> edges_;
  std::vector<float> away_;  // squared, of a block from where its faces meet, m^2
};

}  // namespace palpate
