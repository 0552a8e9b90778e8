// Makes the cloud of the speed tables.
#include "clouds.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace palpate::bench {
namespace {

constexpr double kRadius = 0.1;  // m; judgement: a thing that fits a hand
constexpr double kBumps = 0.05;  // height of bumps / radius; judgement

// Uniform in [-1, 1) from the generator's bits: the same on every standard library.
double uniform(std::mt19937_64& generator) {
  return std::ldexp(static_cast<double>(generator() >> 11), -52) - 1;
}

Eigen::Vector3d direction(std::mt19937_64& generator) {
  for (;;) {
    const Eigen::Vector3d v(uniform(generator), uniform(generator), uniform(generator));
    const double squared = v.squaredNorm();
    if (squared < 1 && squared > 1e-6) return v / std::sqrt(squared);
  }
}

}  // namespace

double bumpy_sphere_spacing(std::size_t count) {
  return kRadius * std::sqrt(4 * std::numbers::pi / static_cast<double>(count));
}

std::vector<Eigen::Vector3f> bumpy_sphere(std::size_t count) {
  std::mt19937_64 generator(20120514);
  const double noise =
      0.1 * std::sqrt(3.) * bumpy_sphere_spacing(count);  // of a uniform's half width
  std::vector<Eigen::Vector3f> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d d = direction(generator);
    const double bump = kBumps * std::sin(8 * d.x()) * std::sin(8 * d.y()) * std::sin(8 * d.z());
    const double radius = kRadius * (1 + bump) + noise * uniform(generator);
    points.push_back((radius * d).cast<float>());
  }
  return points;
}

}  // namespace palpate::bench
