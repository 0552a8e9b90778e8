// A shape given by a formula instead of points: the proxy takes any Field. The force of a ball is
// known exactly, so this also shows how close the proxy comes to it.
#include <cmath>
#include <cstdio>
#include <palpate/field/analytic.hpp>
#include <palpate/palpate.hpp>

int main() {
  const double radius = 0.05;    // m
  const double stiffness = 500;  // N/m
  const double depth = 0.004;    // m
  const palpate::SphereField ball(radius);
  // The proxy stops this many step lengths (of 1 cm here) short of the nearest place.
  palpate::Proxy proxy({.stiffness = stiffness, .tangent_tolerance = 1e-6});

  double worst = 0;  // N
  for (int step = 0; step < 1000; ++step) {
    const double angle = 2e-3 * step;                        // rad
    const double height = step == 0 ? 0.1 : radius - depth;  // from the middle of the ball, m
    const Eigen::Vector3d outward(std::cos(angle), 0, std::sin(angle));
    const palpate::Contact contact = proxy.step(ball, height * outward, 1e-3);
    if (step == 0) continue;
    worst = std::fmax(worst, (contact.force - stiffness * depth * outward).norm());
  }
  std::printf("force %.3f N all around, off by at most %.1e N\n", stiffness * depth, worst);
  return worst < 1e-4 ? 0 : 1;
}
