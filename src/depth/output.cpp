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

// What some blocks of a row become, in columns for the compiler to take several side by side.
struct Part {
  static constexpr int kMost = 64;
  float x[kMost], z[kMost], normal_x[kMost], normal_y[kMost], normal_z[kMost];
};

// The rays are (x, y, 1). How far the next column's and row's points are on the tangent plane is
// the spacing.
struct Rays {
  float y, step_x, step_y, pitch;

  void follow(const BlockFits& fits, std::size_t first, int count, Part& part,
              FilteredDepth& out) const {
    const float* const rho = &fits.rho[first];
    const float* const slope_x = &fits.slope_x[first];
    const float* const slope_y = &fits.slope_y[first];
    const float* const variance = &fits.variance[first];
    float* const deviations = &out.deviations[first];
    float* const spacings = &out.spacings[first];
    for (int k = 0; k < count; ++k) {
      const float x = part.x[k];
      const float z = rho[k] > 0 ? 1 / rho[k] : 0;  // of an empty block: nowhere
      const float a = slope_x[k];
      const float b = slope_y[k];
      const float c = rho[k] - a * x - b * y;
      // Towards the sensor: the plane (a, b, c) . p = 1 has its origin in front.
      const float per_length = -1 / std::sqrt(a * a + b * b + c * c);
      part.z[k] = z;
      part.normal_x[k] = per_length * a;
      part.normal_y[k] = per_length * b;
      part.normal_z[k] = per_length * c;
      const float za = z * a;
      const float zb = z * b;
      const float ahead = 1 - za * x;
      const float along = 1 - zb * y;
      const float right2 = (ahead * ahead + za * za * (y * y + 1)) * step_x * step_x;
      const float below2 = (along * along + zb * zb * (x * x + 1)) * step_y * step_y;
      const float spacing = z * std::sqrt(right2 > below2 ? right2 : below2);
      const float most = kMostGrazing * z * pitch;
      spacings[k] = spacing < most ? spacing : most;
      deviations[k] = std::sqrt(variance[k] * (x * x + y * y + 1)) * z * z;
    }
  }
};

}  // namespace

void resize(const BlockGrid& grid, FilteredDepth& out) {
  out.columns = grid.columns;
  out.rows = grid.rows;
  out.pitch = std::max(std::abs(grid.step_x), std::abs(grid.step_y));
  const std::size_t size = grid.size();
  out.states.resize(size, FilteredDepth::State::empty);
  out.positions.resize(size, Vector3f::Zero());
  out.normals.resize(size, Vector3f::Zero());
  out.confidences.resize(size);
  out.deviations.resize(size);
  out.spacings.resize(size);
}

void write_points(const BlockFits& fits, const DepthRange& range, FilteredDepth& out) {
  const BlockGrid& grid = fits.grid;
  const auto farthest = static_cast<float>(1 / ((1 + kBeyond) * range.farthest));
  const auto nearest = static_cast<float>((1 + kBeyond) / range.nearest);
  for_rows(grid, [&](int row) {
    const Rays rays{static_cast<float>(grid.y(row)), static_cast<float>(grid.step_x),
                    static_cast<float>(grid.step_y), static_cast<float>(out.pitch)};
    Part part;
    for (int first = 0; first < grid.columns; first += Part::kMost) {
      const int count = std::min(Part::kMost, grid.columns - first);
      std::size_t i = grid.index(first, row);
      for (int k = 0; k < count; ++k) part.x[k] = static_cast<float>(grid.x(first + k));
      rays.follow(fits, i, count, part, out);
      for (int k = 0; k < count; ++k, ++i) {
        const bool sane = fits.rho[i] >= farthest && fits.rho[i] <= nearest;
        out.states[i] = sane ? fits.states[i] : FilteredDepth::State::empty;
        out.positions[i] = part.z[k] * Vector3f(part.x[k], rays.y, 1);
        const bool known = fits.confidences[i] > 0;
        const Vector3f normal(part.normal_x[k], part.normal_y[k], part.normal_z[k]);
        out.normals[i] = known ? normal : Vector3f(Vector3f::Zero());
        out.confidences[i] = fits.confidences[i];
      }
    }
  });
}

}  // namespace palpate::depth
