#include "depth/output.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

using Eigen::Vector3f;

// A plane that seems to be seen at less than 6 degrees is noise: its neighbours are not farther
// away than so many block widths.
constexpr float kMostGrazing = 10;

// A fit may leave the range of measured depths by this share.
constexpr double kBeyond = 0.25;

// Towards the sensor: the plane (a, b, c) . p = 1 has its origin in front.
Vector3f normal_of(const Vector3f& plane) {
  const float length = plane.norm();
  return length > 0 ? Vector3f(-plane / length) : Vector3f(Vector3f::Zero());
}

}  // namespace

void resize(const BlockGrid& grid, FilteredDepth& out) {
  out.columns = grid.columns;
  out.rows = grid.rows;
  out.pitch = std::max(std::abs(grid.step_x), std::abs(grid.step_y));
  const std::size_t size = grid.size();
  out.states.resize(size, BlockState::empty);
  out.positions.resize(size, Vector3f::Zero());
  out.normals.resize(size, Vector3f::Zero());
  out.confidences.resize(size);
  out.deviations.resize(size);
  out.spacings.resize(size);
}

void write_points(const BlockFits& fits, const DepthRange& range, FilteredDepth& out) {
  const BlockGrid& grid = fits.grid;
  const auto step_x = static_cast<float>(grid.step_x);
  const auto step_y = static_cast<float>(grid.step_y);
  const auto farthest = static_cast<float>(1 / ((1 + kBeyond) * range.farthest));
  const auto nearest = static_cast<float>((1 + kBeyond) / range.nearest);
  for_rows(grid, [&](int row) {
    std::size_t i = grid.index(0, row);
    const auto y = static_cast<float>(grid.y(row));
    for (int column = 0; column < grid.columns; ++column, ++i) {
      const bool sane = fits.rho[i] >= farthest && fits.rho[i] <= nearest;
      out.states[i] = sane ? fits.states[i] : BlockState::empty;
      if (out.states[i] == BlockState::empty) continue;
      const auto x = static_cast<float>(grid.x(column));
      const Vector3f ray(x, y, 1);
      const float z = 1 / fits.rho[i];
      const float a = fits.slope_x[i];
      const float b = fits.slope_y[i];
      out.positions[i] = z * ray;
      const bool known = fits.confidences[i] > 0;
      out.normals[i] =
          known ? normal_of(Vector3f(a, b, fits.rho[i] - a * x - b * y)) : Vector3f(0, 0, 0);
      out.confidences[i] = fits.confidences[i];
      out.deviations[i] = std::sqrt(fits.variance[i] * ray.squaredNorm()) * z * z;
      // How far the next column's and row's points are on the tangent plane.
      const Vector3f to_right = z * step_x * (Vector3f::UnitX() - z * a * ray);
      const Vector3f below = z * step_y * (Vector3f::UnitY() - z * b * ray);
      const float spacing = std::sqrt(std::max(to_right.squaredNorm(), below.squaredNorm()));
      out.spacings[i] = std::min(spacing, kMostGrazing * z * static_cast<float>(out.pitch));
    }
  });
}

}  // namespace palpate::depth
