#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "base/numbers.hpp"
#include "depth/blocks.hpp"
#include "depth/temporal_filter.hpp"

namespace palpate::test {

/// Takes in all rows of a frame.
inline void filter(depth::TemporalFilter& filter, const depth::TemporalOptions& options,
                   const Eigen::Isometry3d& T_world_sensor, depth::BlockFits& fits) {
  filter.begin(fits.grid, T_world_sensor);
  std::vector<std::uint8_t> settled(fits.size());
  for (int row = 0; row < fits.grid.rows; ++row) {
    filter.filter(options, row, 0, fits.grid.columns, fits, &settled[fits.grid.index(0, row)]);
  }
}

/// A camera of 160 x 120 blocks whose blocks are as wide as the Kinect's.
inline depth::BlockGrid block_camera(int columns = 160, int rows = 120) {
  const double step = 2 / 525.0;
  return {columns, rows, -0.5 * step * (columns - 1), -0.5 * step * (rows - 1), step, step};
}

/// A surface in front of a camera: a plane and, if its radius is not 0, a ball.
struct BlockScene {
  Eigen::Vector3d plane_point = {0, 0, 0.8};
  Eigen::Vector3d plane_normal = {0, 0, -1};
  Eigen::Vector3d ball_center = {0, 0, 0.7};
  double ball_radius = 0;
};

/// The exact tangent plane where the ray (x, y, 1) meets the scene, as a with a.p = 1.
inline Eigen::Vector3d tangent_at(const BlockScene& scene, const Eigen::Isometry3d& T_sensor_world,
                                  double x, double y, bool* on_ball = nullptr) {
  const Eigen::Vector3d ray(x, y, 1);
  const Eigen::Vector3d n = T_sensor_world.linear() * scene.plane_normal;
  const Eigen::Vector3d o = T_sensor_world * scene.plane_point;
  Eigen::Vector3d tangent = n / n.dot(o);
  if (on_ball != nullptr) *on_ball = false;
  if (scene.ball_radius <= 0) return tangent;
  const Eigen::Vector3d c = T_sensor_world * scene.ball_center;
  const double b = ray.dot(c);
  const double under =
      b * b - ray.squaredNorm() * (c.squaredNorm() - scene.ball_radius * scene.ball_radius);
  if (under <= 0) return tangent;
  const double z = (b - std::sqrt(under)) / ray.squaredNorm();
  if (z <= 0 || 1 / z < tangent.dot(ray)) return tangent;
  const Eigen::Vector3d p = z * ray;
  if (on_ball != nullptr) *on_ball = true;
  return (p - c) / (p - c).dot(p);
}

inline void set_block(depth::BlockFits& fits, std::size_t i, const Eigen::Vector3d& tangent,
                      double rho, double sd, double slope_sd) {
  fits.states[i] = FilteredDepth::State::fitted;
  fits.rho[i] = static_cast<float>(rho);
  fits.variance[i] = static_cast<float>(sd * sd);
  fits.slope_x[i] = static_cast<float>(tangent.x());
  fits.slope_y[i] = static_cast<float>(tangent.y());
  fits.slope_variance[i] = static_cast<float>(slope_sd * slope_sd);
  fits.confidences[i] = 1;
}

/// What the fits would make of the scene: the truth and independent noise of `sd` (1/m) on inverse
/// depths and `slope_sd` on slopes.
inline void measure(const BlockScene& scene, const Eigen::Isometry3d& T_world_sensor, double sd,
                    double slope_sd, Random& random, depth::BlockFits& fits) {
  const Eigen::Isometry3d T_sensor_world = T_world_sensor.inverse();
  const depth::BlockGrid grid = fits.grid;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double x = grid.x(column);
      const double y = grid.y(row);
      Eigen::Vector3d tangent = tangent_at(scene, T_sensor_world, x, y);
      const double rho = tangent.dot(Eigen::Vector3d(x, y, 1)) + sd * random.normal();
      tangent.x() += slope_sd * random.normal();
      tangent.y() += slope_sd * random.normal();
      set_block(fits, grid.index(column, row), tangent, rho, sd, slope_sd);
    }
  }
}

/// Errors of the blocks' inverse depths as depth, m.
struct BlockErrors {
  double mean = 0;
  double rms = 0;
  double worst = 0;
  int count = 0;
};

/// `margin`: blocks along the border that are left out. `ball`: 1 only on the ball, 0 only off it,
/// -1 both; within two blocks of its silhouette neither.
inline BlockErrors errors_of(const depth::BlockFits& fits, const BlockScene& scene,
                             const Eigen::Isometry3d& T_world_sensor, int ball = -1,
                             int margin = 0) {
  const Eigen::Isometry3d T_sensor_world = T_world_sensor.inverse();
  const depth::BlockGrid grid = fits.grid;
  BlockErrors errors;
  for (int row = margin; row < grid.rows - margin; ++row) {
    for (int column = margin; column < grid.columns - margin; ++column) {
      const double x = grid.x(column);
      const double y = grid.y(row);
      bool here = false;
      const Eigen::Vector3d tangent = tangent_at(scene, T_sensor_world, x, y, &here);
      bool edge = false;
      for (const int d : {-2, 2}) {
        bool there = false;
        tangent_at(scene, T_sensor_world, grid.x(column + d), y, &there);
        edge = edge || there != here;
        tangent_at(scene, T_sensor_world, x, grid.y(row + d), &there);
        edge = edge || there != here;
      }
      if (edge || (ball >= 0 && here != (ball == 1))) continue;
      const std::size_t i = grid.index(column, row);
      if (fits.states[i] == FilteredDepth::State::empty) continue;
      const double error =
          1 / static_cast<double>(fits.rho[i]) - 1 / tangent.dot(Eigen::Vector3d(x, y, 1));
      errors.mean += error;
      errors.rms += error * error;
      errors.worst = std::max(errors.worst, std::abs(error));
      ++errors.count;
    }
  }
  errors.mean /= std::max(1, errors.count);
  errors.rms = std::sqrt(errors.rms / std::max(1, errors.count));
  return errors;
}

}  // namespace palpate::test
