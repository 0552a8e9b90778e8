#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "field/formulas.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/field/surface_points.hpp"

namespace palpate::test {

/// One point as a test thinks of it.
struct TestPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double radius = 10e-3;
  double confidence = 1;
};

/// a_i of docs/method.md 2.2 by brute force.
inline std::vector<float> brute_density_weights(const std::vector<TestPoint>& points,
                                                Kernel kernel = Kernel::wyvill) {
  const auto weight = [&](std::size_t i, std::size_t j) {
    const double r = points[i].radius;
    return evaluate(kernel, (points[i].position - points[j].position).squaredNorm() / (r * r)).w;
  };
  std::vector<double> sums(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) sums[i] += weight(i, j);
  }
  std::vector<float> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    double mean = 0;
    for (std::size_t j = 0; j < points.size(); ++j) mean += weight(i, j) * sums[j];
    result[i] = static_cast<float>(1 / std::max(sums[i], 0.8 * mean / sums[i]));
  }
  return result;
}

/// Indexed points without any preparation.
inline SurfacePoints make_points(const std::vector<TestPoint>& points,
                                 Kernel kernel = Kernel::wyvill) {
  std::vector<Eigen::Vector3f> positions;
  for (const TestPoint& p : points) positions.push_back(p.position.cast<float>());
  SurfacePoints result;
  result.kernel = kernel;
  result.grid = CellGrid(positions);
  const auto weights = brute_density_weights(points, kernel);
  for (const std::uint32_t i : result.grid.order()) {
    result.normals.push_back(points[i].normal.cast<float>());
    result.density_weights.push_back(weights[i]);
    result.radii.push_back(static_cast<float>(points[i].radius));
    result.confidences.push_back(static_cast<float>(points[i].confidence));
  }
  finish(result);
  return result;
}

/// A wavy sheet of 4 mm spacing around the origin with uneven radii and confidences.
inline std::vector<TestPoint> wavy_sheet(unsigned seed, double doubtful = 0.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-1, 1);
  std::vector<TestPoint> points;
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      const double x = 4e-3 * i + 0.8e-3 * jitter(random);
      const double y = 4e-3 * j + 0.8e-3 * jitter(random);
      const double z = 3e-3 * std::sin(60 * x) * std::cos(40 * y) + 0.3e-3 * jitter(random);
      const Eigen::Vector3d tilt(0.2 * jitter(random), 0.2 * jitter(random), 1);
      const double confidence = jitter(random) < 2 * doubtful - 1 ? 0 : 1;
      points.push_back({{x, y, z}, tilt.normalized(), 9e-3 + 3e-3 * jitter(random), confidence});
    }
  }
  return points;
}

}  // namespace palpate::test
