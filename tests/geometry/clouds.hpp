#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace palpate::test {

using Points = std::vector<Eigen::Vector3f>;

/// Clouds of known shape, in metres; jittered and the same in every run.
class Clouds {
 public:
  explicit Clouds(unsigned seed = 1) : generator_(seed) {}

  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(generator_()), -32);
  }

  [[nodiscard]] Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (v.squaredNorm() < 1 && v.squaredNorm() > 1e-3) return v.normalized();
    }
  }

  [[nodiscard]] Points sphere(std::size_t count, double radius,
                              const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
      points.push_back((center + radius * direction()).cast<float>());
    }
    return points;
  }

  /// z = 0; side x side points, `jitter` of a spacing.
  [[nodiscard]] Points plane(int side, double spacing, double jitter = 0) {
    Points points;
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        const Eigen::Vector3d p(i + uniform(-jitter, jitter), j + uniform(-jitter, jitter), 0);
        points.push_back((spacing * p).cast<float>());
      }
    }
    return points;
  }

  [[nodiscard]] Points cube(std::size_t count, double size) {
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d p(uniform(0, size), uniform(0, size), uniform(0, size));
      points.push_back(p.cast<float>());
    }
    return points;
  }

  /// Around the z axis.
  [[nodiscard]] Points torus(int around, int across, double radius, double tube) {
    Points points;
    for (int i = 0; i < around; ++i) {
      for (int j = 0; j < across; ++j) {
        const double u = 2 * std::numbers::pi * (i + uniform(-0.2, 0.2)) / around;
        const double v = 2 * std::numbers::pi * (j + uniform(-0.2, 0.2)) / across;
        const double r = radius + tube * std::cos(v);
        points.push_back(
            Eigen::Vector3d(r * std::cos(u), r * std::sin(u), tube * std::sin(v)).cast<float>());
      }
    }
    return points;
  }

 private:
  std::mt19937 generator_;
};

}  // namespace palpate::test
