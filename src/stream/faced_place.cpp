// Finds a place that a cloud's normals face.
#include "stream/faced_place.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Planes through a sample of a cloud's points. Lengths are in units of the sample's rms distance
/// from its mean, which is the origin.
struct TangentPlanes {
  std::vector<Vector3d> points;
  std::vector<Vector3d> normals;
  Vector3d mean = Vector3d::Zero();  // m
  double unit = 0;                   // m
};

TangentPlanes tangent_planes(const PointCloud& cloud) {
  constexpr std::size_t kSample = 4096;  // gives a share of 1 % to within 0.16 % (derived)
  TangentPlanes planes;
  const std::size_t stride = (cloud.size() + kSample - 1) / kSample;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    planes.points.push_back(cloud.point(i));
    planes.normals.push_back(cloud.normals[i].cast<double>().normalized());
  }
  const auto count = static_cast<double>(planes.points.size());
  for (const Vector3d& p : planes.points) planes.mean += p / count;
  for (Vector3d& p : planes.points) p -= planes.mean;
  for (const Vector3d& p : planes.points) planes.unit += p.squaredNorm() / count;
  planes.unit = std::sqrt(planes.unit);
  for (Vector3d& p : planes.points) p /= planes.unit;
  return planes;
}

/// Minimises the mean square by which `margin` exceeds the height over the planes, by Newton's
/// method: a step is exact where no plane comes to count or ceases to.
Vector3d lowest_place(const TangentPlanes& planes, double margin) {
  constexpr double kRidge = 1e-6;  // of planes that count: sets what they leave open (judgement)
  constexpr int kSteps = 30;       // the planes that count change no longer then (judgement)
  Vector3d place = Vector3d::Zero();
  for (int step = 0; step < kSteps; ++step) {
    Matrix3d matrix = kRidge * static_cast<double>(planes.points.size()) * Matrix3d::Identity();
    Vector3d right = Vector3d::Zero();
    for (std::size_t k = 0; k < planes.points.size(); ++k) {
      const Vector3d& n = planes.normals[k];
      const double wanted = n.dot(planes.points[k]) + margin;
      if (!(n.dot(place) < wanted)) continue;
      matrix += n * n.transpose();
      right += wanted * n;
    }
    const Vector3d next = matrix.ldlt().solve(right);
    if (next == place) break;
    place = next;
  }
  return place;
}

/// To a multiple of a power of ten, no more than `most`.
Vector3d rounded(const Vector3d& place, double most) {
  const double step = std::pow(10, std::floor(std::log10(most)));
  return (place.array() / step).round() * step + 0.0;  // + 0: no -0
}

bool faces(const TangentPlanes& planes, const Vector3d& place) {
  constexpr double kOthers = 0.01;  // as of a viewpoint (OneView)
  const auto is_other = [&](std::size_t k) {
    const Vector3d ray = planes.points[k] - place;
    return !(planes.normals[k].dot(ray) < 0) || !(ray.dot(place) < 0);
  };
  std::size_t others = 0;
  for (std::size_t k = 0; k < planes.points.size(); ++k) others += is_other(k) ? 1 : 0;
  return static_cast<double>(others) <= kOthers * static_cast<double>(planes.points.size());
}

/// Do many points hide others from there, as the near side of a closed body does the far one, whose
/// normals somebody turned over? Half of them do then; beside an object's outline few do.
bool hide(const TangentPlanes& planes, const Vector3d& place) {
  constexpr int kCells = 24;       // of directions, on a side: 7 points of the sample in each
  constexpr double kSpread = 2;    // of directions that count, in rms; judgement
  constexpr double kBehind = 0.5;  // rms of the points; an oblique face has less in a cell
  constexpr double kMany = 0.2;    // share; judgement
  const Vector3d axis = -place.normalized();
  const Vector3d right = axis.unitOrthogonal();
  const Vector3d down = axis.cross(right);
  const double scale = kCells / (2 * kSpread) * place.norm();  // rms of directions is 1 / distance
  const auto cell_of = [&](const Vector3d& ray) {
    const auto part = [&](const Vector3d& side) {
      const double at = scale * ray.dot(side) / ray.dot(axis) + kCells / 2.0;
      return static_cast<std::size_t>(std::clamp(at, 0.0, kCells - 1.0));
    };
    return part(right) * kCells + part(down);
  };
  std::vector<double> nearest(kCells * kCells, std::numeric_limits<double>::infinity());
  for (const Vector3d& p : planes.points) {
    double& least = nearest[cell_of(p - place)];
    least = std::min(least, (p - place).norm());
  }
  const auto hidden = std::ranges::count_if(planes.points, [&](const Vector3d& p) {
    return (p - place).norm() > nearest[cell_of(p - place)] + kBehind;
  });
  return static_cast<double>(hidden) > kMany * static_cast<double>(planes.points.size());
}

}  // namespace

std::optional<Vector3d> faced_place(const PointCloud& cloud) {
  constexpr double kSame = 1e-12;  // of the coordinates: what rounding leaves of one place

  if (cloud.empty() || cloud.normals.size() != cloud.size()) return {};
  const TangentPlanes planes = tangent_planes(cloud);
  if (!(planes.unit > kSame * planes.mean.norm()) || !std::isfinite(planes.unit)) return {};
  for (const double margin : {3.0, 1.0, 0.3, 0.1, 0.03}) {
    const Vector3d place = rounded(planes.mean + planes.unit * lowest_place(planes, margin),
                                   0.1 * margin * planes.unit);
    const Vector3d scaled = (place - planes.mean) / planes.unit;
    if (faces(planes, scaled) && !hide(planes, scaled)) return place;
  }
  return {};
}

}  // namespace palpate
