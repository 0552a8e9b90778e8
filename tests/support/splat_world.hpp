// Makes scenes of splats as a phone's photographs of the world give them.
#pragma once

#include "support/splat_scenes.hpp"

namespace palpate::test {

/// Splats of log-normal sizes around `size`, ten times as long as wide. Units are arbitrary.
inline Splat draw_of_size(double size, const Eigen::Vector3d& position,
                          const Eigen::Vector3d& normal, Random& random) {
  const double root = std::sqrt(10.0);
  const SplatLook look{
      .thickness = size / (2 * root), .width = size / root, .length = size * root, .spread = 0.7};
  return draw_splat(look, position, normal, random);
}

inline constexpr double kWorldBall = 0.3;  ///< radius of the ball in the middle of a world

/// Far from the ball, sizes follow the distance: one of the sky's, at 15 to 150 times the radius.
inline Splat draw_sky(Random& random) {
  const double far = 50 * kWorldBall * std::pow(10, random.uniform());
  const Eigen::Vector3d way = random_direction(random);
  return draw_of_size(0.05 * far, far * way, way, random);
}

/// A filled ball, which has 60 % of the splats; ground and houses around it, up to a hundred times
/// as far; the sky, and floaters everywhere. The same seed gives the same splats.
inline std::vector<Splat> make_world(int count, std::uint64_t seed) {
  Random random(seed);
  // Splats that just cover the ball, however many there are.
  const double size = 2.5 * kWorldBall / std::sqrt(static_cast<double>(count));
  std::vector<Splat> splats;
  while (splats.size() < static_cast<std::size_t>(count)) {
    const double kind = random.uniform();
    const Eigen::Vector3d way = random_direction(random);
    if (kind < 0.6) {
      const bool hidden = random.uniform() < 0.25;
      const double inside = hidden ? std::cbrt(random.uniform()) : 1;
      splats.push_back(draw_of_size(size, kWorldBall * inside * way,
                                    hidden ? random_direction(random) : way, random));
    } else if (kind < 0.9) {
      const double far = 3 * kWorldBall * std::pow(30, random.uniform());
      splats.push_back(draw_of_size(0.02 * far, far * way, way, random));
    } else if (kind < 0.93) {
      splats.push_back(draw_sky(random));
    } else {
      const double far = 2 * kWorldBall * (1 + 10 * random.uniform());
      splats.push_back(draw_of_size(size * std::exp(random.normal()), far * way,
                                    random_direction(random), random));
    }
  }
  return splats;
}

}  // namespace palpate::test
