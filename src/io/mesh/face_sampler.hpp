#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/cloud_builder.hpp"
#include "io/mesh/mesh.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate::io {

/// The normal of a face times twice its area (Newell's sum, which polygons that are not plane have,
/// too).
[[nodiscard]] Eigen::Vector3d face_normal(const Mesh& mesh, std::span<const std::uint32_t> face);

/// A box divided into cells, whose edges are as long as a spacing or a little shorter. Lines
/// through the middles of cells, along the axes, meet faces in samples: so faces of one plane
/// share one pattern, and a box's own faces have samples half a cell inside their edges.
class Lattice {
 public:
  Lattice(const Box& box, double spacing);

  /// Cells from the middle of the first one to `x`, along an axis.
  [[nodiscard]] double cells(double x, int axis) const {
    return (x - lower_[axis]) / step_[axis] - 0.5;
  }
  /// The middle of a cell.
  [[nodiscard]] double middle(double cell, int axis) const {
    return lower_[axis] + (cell + 0.5) * step_[axis];
  }
  /// Samples that faces of this area, as seen along the axes, get at most, roughly.
  [[nodiscard]] std::size_t room(double area) const;

 private:
  Eigen::Vector3d lower_;
  Eigen::Vector3d step_;
};

/// Samples faces where lines of a lattice meet them, along the axis that is nearest to each face's
/// normal. An edge that two faces share belongs to one of them.
class FaceSampler {
 public:
  /// Bounds at which it stops.
  struct Bounds {
    double points = 0;  ///< of the builder
    double work = 0;    ///< comparisons
  };

  /// All but the bounds must outlive it.
  FaceSampler(const Mesh& mesh, const Lattice& lattice, CloudBuilder& builder, const Bounds& bounds)
      : mesh_(mesh), lattice_(lattice), builder_(builder), bounds_(bounds) {}

  /// Corners of a face that is finite and has an area.
  void add(std::span<const std::uint32_t> face);

  /// Has it stopped, as there are more points than its bounds allow?
  [[nodiscard]] bool points_spent() const {
    return static_cast<double>(builder_.size()) > bounds_.points;
  }
  /// Has it stopped, as there was more work?
  [[nodiscard]] bool work_spent() const { return work_ > bounds_.work; }

 private:
  // Where a row of cells crosses an edge.
  struct Crossing {
    double column = 0;  // cells
    MeshVertex vertex;
  };

  void find_crossings(std::span<const std::uint32_t> face, double row);
  void fill(const Crossing& from, const Crossing& to, double row);

  const Mesh& mesh_;
  const Lattice& lattice_;
  CloudBuilder& builder_;
  Bounds bounds_;
  double work_ = 0;  // comparisons so far
  Eigen::Vector3d normal_;
  int across_ = 0;  // axis of columns
  int up_ = 0;      // axis of rows
  std::vector<Crossing> crossings_;
};

}  // namespace palpate::io
