// Samples faces evenly, by lines through a lattice.
#include "io/mesh/face_sampler.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace palpate::io {

using Eigen::Vector3d;

Vector3d face_normal(const Mesh& mesh, std::span<const std::uint32_t> face) {
  Vector3d sum = Vector3d::Zero();
  if (face.size() < 3) return sum;
  const Vector3d first = mesh.vertices[face[0]].head<3>();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Vector3d a = mesh.vertices[face[i]].head<3>() - first;
    const Vector3d b = mesh.vertices[face[i + 1]].head<3>() - first;
    sum += a.cross(b);
  }
  return sum;
}

Lattice::Lattice(const Box& box, double spacing) : lower_(box.lower) {
  const Vector3d size = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::max(1.0, std::ceil(size[axis] / spacing));
    step_[axis] = size[axis] > 0 ? size[axis] / cells : spacing;
  }
}

std::size_t Lattice::room(double area) const {
  constexpr double kMost = 4e6;  // samples; more are given room as they come (judgement)
  const double smallest = step_[0] * step_[1] * step_[2] / step_.maxCoeff();
  const double samples = area / smallest;
  return samples < kMost ? static_cast<std::size_t>(samples)
                         : static_cast<std::size_t>(kMost);  // and for NaN
}

void FaceSampler::add(std::span<const std::uint32_t> face) {
  const Vector3d twice = face_normal(mesh_, face);
  normal_ = twice.normalized();
  int along = 0;
  twice.cwiseAbs().maxCoeff(&along);
  across_ = (along + 1) % 3;
  up_ = (along + 2) % 3;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const std::uint32_t corner : face) {
    const double row = lattice_.cells(mesh_.vertices[corner][up_], up_);
    lowest = std::min(lowest, row);
    highest = std::max(highest, row);
  }
  for (double row = std::ceil(lowest); row < highest; ++row) {
    find_crossings(face, row);
    for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2) {
      fill(crossings_[i], crossings_[i + 1], row);
    }
    if (points_spent() || work_spent()) return;
  }
}

// Edges are taken from their lower to their higher end, so that two faces that share one round
// alike.
void FaceSampler::find_crossings(std::span<const std::uint32_t> face, double row) {
  crossings_.clear();
  for (std::size_t i = 0; i < face.size(); ++i) {
    const MeshVertex* from = &mesh_.vertices[face[i]];
    const MeshVertex* to = &mesh_.vertices[face[(i + 1) % face.size()]];
    if ((*from)[up_] > (*to)[up_]) std::swap(from, to);
    const double low = lattice_.cells((*from)[up_], up_);
    const double high = lattice_.cells((*to)[up_], up_);
    if (!(low <= row && row < high)) continue;
    const MeshVertex vertex = *from + (row - low) / (high - low) * (*to - *from);
    crossings_.push_back({lattice_.cells(vertex[across_], across_), vertex});
  }
  std::ranges::sort(crossings_, {}, &Crossing::column);
  const std::size_t sorting =
      crossings_.size() * static_cast<std::size_t>(std::bit_width(crossings_.size()));
  work_ += static_cast<double>(face.size() + sorting);
}

void FaceSampler::fill(const Crossing& from, const Crossing& to, double row) {
  for (double column = std::ceil(from.column); column < to.column; ++column) {
    const double share = (column - from.column) / (to.column - from.column);
    MeshVertex sample = from.vertex + share * (to.vertex - from.vertex);
    sample[across_] = lattice_.middle(column, across_);
    sample[up_] = lattice_.middle(row, up_);
    Row values;
    std::copy_n(sample.data(), 3, values.begin());
    std::copy_n(normal_.data(), 3, values.begin() + index_of(Role::normal_x));
    std::copy_n(sample.data() + 3, 4, values.begin() + index_of(Role::red));
    builder_.add(values);
  }
}

}  // namespace palpate::io
