#include "scene/noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSamples = 1000;
// In spacings: narrow, so that fine shape is no noise. Wider only where coarse depth steps make
// every narrow neighbourhood flat.
constexpr double kReaches[] = {3, 6, 12};
constexpr double kFlat = 1e-3;       // of the spacing
constexpr std::size_t kEnough = 12;  // neighbours
constexpr int kTerms = 6;            // of a quadratic height

struct Frame {
  Vector3d mean;
  Eigen::Matrix3d axes;  // columns by rising variance: the first is the normal
};

Frame frame_of(const CellGrid& grid, const std::vector<std::uint32_t>& near) {
  Vector3d mean = Vector3d::Zero();
  for (const auto i : near) mean += grid.points()[i].cast<double>();
  mean /= static_cast<double>(near.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto i : near) {
    const Vector3d d = grid.points()[i].cast<double>() - mean;
    scatter += d * d.transpose();
  }
  return {mean, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors()};
}

/// Rms residual of a quadratic height over the neighbourhood's plane: curvature is no noise.
double quadratic_residual(const CellGrid& grid, const std::vector<std::uint32_t>& near,
                          double scale) {
  const Frame frame = frame_of(grid, near);
  const auto rows = static_cast<Eigen::Index>(near.size());
  Eigen::Matrix<double, Eigen::Dynamic, kTerms> terms(rows, kTerms);
  Eigen::VectorXd heights(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const Vector3d d = grid.points()[near[static_cast<std::size_t>(k)]].cast<double>() - frame.mean;
    const double u = frame.axes.col(1).dot(d) / scale;
    const double v = frame.axes.col(2).dot(d) / scale;
    terms.row(k) << 1, u, v, u * u, u * v, v * v;
    heights[k] = frame.axes.col(0).dot(d);
  }
  const Eigen::VectorXd fitted = terms * terms.colPivHouseholderQr().solve(heights);
  return std::sqrt((heights - fitted).squaredNorm() / static_cast<double>(rows - kTerms));
}

/// The median residual over samples of the grid; 0 where none has enough neighbours.
double noise_within(const CellGrid& grid, double reach) {
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kSamples);
  std::vector<float> residuals;
  std::vector<std::uint32_t> near;
  for (std::size_t i = step / 2; i < grid.size(); i += step) {
    near.clear();
    grid.within(grid.points()[i], static_cast<float>(reach), near);
    if (near.size() < kEnough) continue;
    residuals.push_back(static_cast<float>(quadratic_residual(grid, near, reach)));
  }
  return median(std::move(residuals));
}

}  // namespace

double plane_noise(const CellGrid& grid, double spacing) {
  double noise = 0;
  for (const double reach : kReaches) {
    noise = noise_within(grid, reach * spacing);
    if (noise > kFlat * spacing) break;
  }
  return noise;
}

}  // namespace palpate
