// Makes scenes of Gaussian splats whose surface is known.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/numbers.hpp"
#include "extras/splats/splat_shell.hpp"

namespace palpate::test {

/// A place on a surface and the direction out of the solid.
struct SurfacePlace {
  Eigen::Vector3d position;  ///< m
  Eigen::Vector3d normal;
};

/// A surface that splats can be strewn on.
struct SplatShape {
  std::function<SurfacePlace(Random&)> draw;
  std::function<double(const Eigen::Vector3d&)> distance;  ///< below 0 in the solid, m
};

/// The statistics of trained scenes, in the size of a hand: half of all splats are needles, and
/// three of five have an opacity below 0.3.
struct SplatLook {
  int count = 8000;
  double thickness = 0.3e-3;  ///< smallest sigma, median, m
  double width = 1.4e-3;      ///< middle sigma, median, m
  double length = 7e-3;       ///< largest sigma, median, m
  double spread = 0.4;        ///< deviation of their logarithms
  double tilt = 8;            ///< deviation of normals, degrees
  double soft = 0.4e-3;       ///< deviation of heights above the surface, m
  double floaters = 0.03;     ///< share of splats that float around
  double clear = 0.03;        ///< from the surface to any of those, m
  double hidden = 0;          ///< share that fills the inside
  double dim = 2.36;          ///< opacity is a uniform number to this power
};

inline Eigen::Vector3d random_direction(Random& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

inline Splat draw_splat(const SplatLook& look, const Eigen::Vector3d& position,
                        const Eigen::Vector3d& normal, Random& random) {
  const Eigen::Vector3d along = normal.cross(random_direction(random)).normalized();
  Eigen::Matrix3d axes;
  axes << normal, along.cross(normal), along;
  const auto around = [&](double median) {
    return median * std::exp(look.spread * random.normal());
  };
  Splat splat;
  splat.position = position.cast<float>();
  splat.rotation = Eigen::Quaternionf(axes.cast<float>());
  const double thickness = around(look.thickness);
  const double width = around(look.width);
  splat.sigma = Eigen::Vector3d(thickness, width, around(look.length)).cast<float>();
  splat.opacity = static_cast<float>(std::pow(random.uniform(), look.dim));
  splat.color = {200, 100, 50};
  return splat;
}

inline constexpr double kFloat = 0.4;  ///< edge of the cube that floaters are in, m

/// Strews splats on the shape; the same seed gives the same splats.
inline std::vector<Splat> make_splats(const SplatShape& shape, const SplatLook& look,
                                      std::uint64_t seed) {
  Random random(seed);
  std::vector<Splat> splats;
  while (splats.size() < static_cast<std::size_t>(look.count)) {
    const double kind = random.uniform();
    const SurfacePlace place = shape.draw(random);
    if (kind < look.floaters) {
      const Eigen::Vector3d even(random.uniform(), random.uniform(), random.uniform());
      const Eigen::Vector3d position = kFloat * (even.array() - 0.5).matrix();
      if (std::abs(shape.distance(position)) < look.clear) continue;
      splats.push_back(draw_splat(look, position, random_direction(random), random));
    } else if (kind < look.floaters + look.hidden) {
      const Eigen::Vector3d position = place.position * std::cbrt(random.uniform());
      const Splat splat = draw_splat(look, position, random_direction(random), random);
      // None sticks out.
      if (shape.distance(position) < -2 * static_cast<double>(splat.sigma.maxCoeff())) {
        splats.push_back(splat);
      }
    } else {
      const Eigen::Vector3d lean = kDegree * look.tilt * random.normal() * random_direction(random);
      const Eigen::Vector3d normal = (place.normal + lean).normalized();
      const Eigen::Vector3d position = place.position + look.soft * random.normal() * place.normal;
      splats.push_back(draw_splat(look, position, normal, random));
    }
  }
  return splats;
}

/// A square of the plane z = 0, `size` wide, solid below.
inline SplatShape splat_plane(double size = 0.2) {
  return {[=](Random& random) {
            const double x = size * (random.uniform() - 0.5);
            const double y = size * (random.uniform() - 0.5);
            return SurfacePlace{{x, y, 0}, Eigen::Vector3d::UnitZ()};
          },
          [](const Eigen::Vector3d& p) { return p.z(); }};
}

inline SplatShape splat_sphere(double radius = 0.06) {
  return {[=](Random& random) {
            const Eigen::Vector3d normal = random_direction(random);
            return SurfacePlace{radius * normal, normal};
          },
          [=](const Eigen::Vector3d& p) { return p.norm() - radius; }};
}

/// A cube around the origin.
inline SplatShape splat_box(double size = 0.1) {
  const double half = size / 2;
  return {[=](Random& random) {
            const auto face = static_cast<Eigen::Index>(3 * random.uniform());
            Eigen::Vector3d normal = Eigen::Vector3d::Zero();
            normal[face] = random.uniform() < 0.5 ? -1 : 1;
            Eigen::Vector3d position(random.uniform(), random.uniform(), random.uniform());
            position = size * (position.array() - 0.5).matrix();
            position[face] = half * normal[face];
            return SurfacePlace{position, normal};
          },
          [=](const Eigen::Vector3d& p) {
            const Eigen::Array3d outside = p.array().abs() - half;
            return outside.max(0).matrix().norm() + std::min(outside.maxCoeff(), 0.0);
          }};
}

}  // namespace palpate::test
