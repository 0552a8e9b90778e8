// The penalty force on a moving-least-squares surface (Lee and Kim 2007).
#include "rivals/mls.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "rivals/make.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kWidth = 2;        // s; judgement: some 12 points weigh
constexpr double kCut = 3;          // widths; derived: the weight there is 1e-4
constexpr int kIterations = 3;      // judgement: the foot stands still then
constexpr std::size_t kFewest = 8;  // points; derived: six coefficients and two to spare

struct Plane {
  Vector3d middle = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
};

double weight(const Vector3d& way, double width) {
  return std::exp(-way.squaredNorm() / (width * width));
}

Plane fit_plane(const NearPoints& points, std::span<const std::uint32_t> near, const Vector3d& x,
                double width) {
  double sum = 0;
  Vector3d first = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : near) {
    const Vector3d way = points.at(i) - x;
    const double w = weight(way, width);
    sum += w;
    first += w * way;
    second += w * way * way.transpose();
  }
  first /= sum;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(second / sum - first * first.transpose());
  return {x + first, solver.eigenvectors().col(0)};
}

// A quadratic height over the plane through x, by coefficients of 1, u, v, uu, uv, vv.
Vector6d fit_height(const NearPoints& points, std::span<const std::uint32_t> near,
                    const Vector3d& x, const Eigen::Matrix3d& axes, double width) {
  Matrix6d squares = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  for (const std::uint32_t i : near) {
    const Vector3d way = points.at(i) - x;
    const Vector3d local = axes.transpose() * way / width;
    const double u = local.x(), v = local.y();
    const Vector6d terms{1, u, v, u * u, u * v, v * v};
    const double w = weight(way, width);
    squares += w * terms * terms.transpose();
    right += w * local.z() * terms;
  }
  return squares.ldlt().solve(right);
}

class Mls final : public Rival {
 public:
  explicit Mls(double scale) : scale_(scale) {}

  void show(const Shown& shown) override {
    points_ = NearPoints(*shown.cloud);
    width_ = kWidth * scale_ * shown.spacing;
  }

  void reset(const Vector3d& /*hip*/) override {}

  Step step(const Vector3d& hip) override {
    const std::optional<MlsFoot> foot = project_mls(points_, width_, hip);
    if (!foot) return spring(hip, hip);
    const double depth = std::max(0.0, foot->normal.dot(foot->place - hip));
    return spring(hip + depth * foot->normal, hip);
  }

 private:
  double scale_;
  double width_ = 0;
  NearPoints points_;
};

}  // namespace

std::optional<MlsFoot> project_mls(const NearPoints& points, double width, const Vector3d& x) {
  if (points.size() < kFewest) return std::nullopt;
  const std::uint32_t closest = points.nearest(x);
  const Vector3d outside = points.outside(closest);
  Vector3d foot = points.at(closest);
  Plane plane;
  for (int i = 0; i < kIterations; ++i) {
    const std::span<const std::uint32_t> near = points.within(foot, kCut * width);
    if (near.size() < kFewest) return std::nullopt;
    plane = fit_plane(points, near, foot, width);
    if (plane.normal.dot(outside) < 0) plane.normal = -plane.normal;
    foot = x - plane.normal * plane.normal.dot(x - plane.middle);
  }
  const std::span<const std::uint32_t> near = points.within(foot, kCut * width);
  if (near.size() < kFewest) return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(2) = plane.normal;
  axes.col(0) = plane.normal.unitOrthogonal();
  axes.col(1) = plane.normal.cross(axes.col(0));
  const Vector6d height = fit_height(points, near, foot, axes, width);
  if (!height.allFinite()) return std::nullopt;
  return MlsFoot{foot + width * height[0] * plane.normal,
                 (axes * Vector3d(-height[1], -height[2], 1)).normalized()};
}

std::unique_ptr<Rival> make_mls(double scale) {
  return std::make_unique<Mls>(scale);
}

}  // namespace palpate::rivals
