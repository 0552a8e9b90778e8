// Draws points of sheets, surfaces and spheres for a scene.
#include "any_cloud/draft.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "any_cloud/spaced_points.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr int kTries = 8;            // in each cell at the surface
constexpr int kSteps = 30;           // to the surface, where a distance is but a bound
constexpr double kOnSurface = 1e-3;  // spacings

}  // namespace

double Draft::between(double low, double high) {
  return low + (high - low) * random.uniform();
}

Vector3d Draft::within(const Vector3d& low, const Vector3d& high) {
  const double x = between(low.x(), high.x());
  const double y = between(low.y(), high.y());
  return {x, y, between(low.z(), high.z())};
}

Vector3d Draft::direction() {
  const double z = between(-1, 1);
  const double angle = between(0, 2 * std::numbers::pi);
  const double flat = std::sqrt(1 - z * z);
  return {flat * std::cos(angle), flat * std::sin(angle), z};
}

void Draft::add(const Vector3d& point, const Vector3d& normal) {
  points.push_back(point);
  normals.push_back(normal);
}

void Draft::sheet(const Vector3d& corner, const Vector3d& along, const Vector3d& across,
                  double step) {
  const int rows = std::max(1, static_cast<int>(std::lround(along.norm() / step)));
  const int columns = std::max(1, static_cast<int>(std::lround(across.norm() / step)));
  const Vector3d normal = along.cross(across).normalized();
  for (int i = 0; i <= rows; ++i) {
    for (int k = 0; k <= columns; ++k) {
      const double u = (i + between(-jitter, jitter)) / rows;
      const double v = (k + between(-jitter, jitter)) / columns;
      add(corner + u * along + v * across, normal);
    }
  }
}

void Draft::surface(const Shape& shape, const Vector3d& low, const Vector3d& high) {
  SpacedPoints taken;
  const Vector3d half = Vector3d::Constant(0.5);
  const double reach = half.norm();
  for (double z = low.z(); z < high.z(); ++z) {
    for (double y = low.y(); y < high.y(); ++y) {
      for (double x = low.x(); x < high.x(); ++x) {
        const Vector3d cell(x, y, z);
        if (std::abs(shape(cell + half).value) > reach) continue;
        for (int i = 0; i < kTries; ++i) {
          const Vector3d near = cell + within(Vector3d::Zero(), 2 * half);
          Distance d = shape(near);
          Vector3d point = near - d.value * d.gradient;
          for (int k = 0; k < kSteps && std::abs((d = shape(point)).value) > kOnSurface; ++k) {
            point -= d.value * d.gradient.normalized();
          }
          if (std::abs(d.value) <= kOnSurface && taken.add(point)) {
            add(point, d.gradient.normalized());
          }
        }
      }
    }
  }
}

void Draft::sphere(double radius) {
  const double count = std::round(4 * std::numbers::pi * radius * radius);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (double i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count;
    const double flat = std::sqrt(1 - z * z);
    const Vector3d out(flat * std::cos(golden * i), flat * std::sin(golden * i), z);
    add(radius * out, out);
  }
}

}  // namespace palpate::any_cloud
