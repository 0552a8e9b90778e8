#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "support/make_points.hpp"

namespace palpate::test {

/// How a shape is sampled: s = 4 mm unless said.
struct Sampling {
  double spacing = 4e-3;  ///< m
  double radius = 10e-3;  ///< R, m
  double jitter = 0;      ///< along the surface, of a spacing
  double noise = 0;       ///< across it, standard deviation, of a spacing
  double tilt = 0;        ///< of normals, standard deviation, rad
  unsigned seed = 1;
};

/// Disturbs points as `sampling` says.
class Disturber {
 public:
  explicit Disturber(const Sampling& sampling) : sampling_(sampling), random_(sampling.seed) {}

  [[nodiscard]] TestPoint operator()(const Eigen::Vector3d& position,
                                     const Eigen::Vector3d& normal) {
    const double s = sampling_.spacing;
    const Eigen::Vector3d shift = s * sampling_.jitter * vector();
    const Eigen::Vector3d along = shift - shift.dot(normal) * normal;
    const Eigen::Vector3d across = s * sampling_.noise * gauss_(random_) * normal;
    return {position + along + across, (normal + sampling_.tilt * vector()).normalized(),
            sampling_.radius};
  }

 private:
  Eigen::Vector3d vector() {
    const double x = gauss_(random_);
    const double y = gauss_(random_);
    return {x, y, gauss_(random_)};
  }
  Sampling sampling_;
  std::mt19937 random_;
  std::normal_distribution<double> gauss_{0, 1};
};

/// A rectangle in the plane z = 0 of `T`, normals along its z; x and y in the ranges given (m).
inline std::vector<TestPoint> sheet(const Sampling& sampling, const Eigen::Vector2d& lower,
                                    const Eigen::Vector2d& upper,
                                    const Eigen::Isometry3d& T = Eigen::Isometry3d::Identity()) {
  Disturber disturb(sampling);
  std::vector<TestPoint> points;
  const double s = sampling.spacing;
  for (int i = 0; lower.x() + i * s <= upper.x() + 1e-9; ++i) {
    for (int j = 0; lower.y() + j * s <= upper.y() + 1e-9; ++j) {
      const Eigen::Vector3d p(lower.x() + i * s, lower.y() + j * s, 0);
      points.push_back(disturb(T * p, T.linear() * Eigen::Vector3d::UnitZ()));
    }
  }
  return points;
}

/// A square sheet of half width `half` (m).
inline std::vector<TestPoint> sheet(const Sampling& sampling, double half, double height = 0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(0, 0, height));
  return sheet(sampling, {-half, -half}, {half, half}, T);
}

/// A ball around the origin, its points in a Fibonacci spiral.
inline std::vector<TestPoint> ball(const Sampling& sampling, double rho) {
  Disturber disturb(sampling);
  std::vector<TestPoint> points;
  const double s = sampling.spacing;
  const int count = static_cast<int>(4 * std::numbers::pi * rho * rho / (s * s));
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d n(r * std::cos(angle), r * std::sin(angle), z);
    points.push_back(disturb(rho * n, n));
  }
  return points;
}

/// Points on the x axis; nobody can tell normals there.
inline std::vector<TestPoint> line(const Sampling& sampling, double half) {
  Disturber disturb(sampling);
  std::vector<TestPoint> points;
  for (double x = -half; x <= half; x += sampling.spacing) {
    points.push_back(disturb({x, 0, 0}, Eigen::Vector3d::UnitZ()));
    points.back().confidence = 0;
  }
  return points;
}

/// A floor and a wall that meet in the y axis at `angle` (rad); free between them.
inline std::vector<TestPoint> wedge(const Sampling& sampling, double angle, double half) {
  std::vector<TestPoint> points = sheet(sampling, {0, -half}, {2 * half, half});
  Eigen::Isometry3d wall = Eigen::Isometry3d::Identity();
  wall.rotate(Eigen::AngleAxisd(std::numbers::pi - angle, Eigen::Vector3d::UnitY()));
  const auto more = sheet(sampling, {-2 * half, -half}, {-sampling.spacing, half}, wall);
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

/// Two sheets with opposite normals, the front one at z = 0.
inline std::vector<TestPoint> plate(const Sampling& sampling, double half, double thickness) {
  std::vector<TestPoint> points = sheet(sampling, half);
  for (TestPoint p : sheet(sampling, half, -thickness)) {
    p.normal = -p.normal;
    points.push_back(p);
  }
  return points;
}

}  // namespace palpate::test
