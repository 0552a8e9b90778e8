#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/cloud_builder.hpp"
#include "io/mesh.hpp"
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
  /// All three must outlive it. Stops where the builder has more than `most` points.
  FaceSampler(const Mesh& mesh, const Lattice& lattice, CloudBuilder& builder, double most)
      : mesh_(mesh), lattice_(lattice), builder_(builder), most_(most) {}

  /// Corners of a face that is finite and has an area.
  void add(std::span<const std::uint32_t> face);

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
  double most_;
  Eigen::Vector3d normal_;
  int across_ = 0;  // axis of columns
  int up_ = 0;      // axis of rows
  std::vector<Crossing> crossings_;
};

}  // namespace palpate::io
