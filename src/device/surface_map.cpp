// Indexes the region of a surface that is explored.
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "device/explore.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kFitNeighbors = 12;  // points in a fitted normal (judgement)

Vector3f middle_of(std::span<const Vector3f> points) {
  Vector3f middle;
  std::vector<float> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    middle[axis] = static_cast<float>(median(values));
  }
  return middle;
}

Vector3f nearest_to(const Vector3f& position, std::span<const Vector3f> points) {
  const auto closer = [&](const Vector3f& a, const Vector3f& b) {
    return (a - position).squaredNorm() < (b - position).squaredNorm();
  };
  return *std::min_element(points.begin(), points.end(), closer);
}

}  // namespace

SurfaceMap::SurfaceMap(const ExploredSurface& surface, double region, double radius)
    : radius_(radius) {
  choose(surface, region);
  if (!normals_.empty()) return;
  normals_.resize(grid_.size());
  for (std::size_t i = 0; i < grid_.size(); ++i) normals_[i] = fitted_normal(i);
}

void SurfaceMap::choose(const ExploredSurface& surface, double region) {
  Box box;
  for (const Vector3f& p : surface.points) box.extend(p.cast<double>());
  const bool everything = box.size().maxCoeff() <= region;
  const Vector3f middle = everything ? Vector3f(box.center().cast<float>())
                                     : nearest_to(middle_of(surface.points), surface.points);
  center_ = middle.cast<double>();
  reach_ = everything ? box.size().norm() : region / 2;
  extent_ = std::min(box.size().maxCoeff(), region);
  const auto kept = static_cast<float>(2 * reach_);
  std::vector<Vector3f> chosen;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if ((surface.points[i] - middle).squaredNorm() > kept * kept) continue;
    chosen.push_back(surface.points[i]);
    indices.push_back(static_cast<std::uint32_t>(i));
  }
  grid_ = CellGrid(chosen);
  if (surface.normals.empty()) return;
  normals_.reserve(chosen.size());
  for (const std::uint32_t k : grid_.order()) normals_.push_back(surface.normals[indices[k]]);
}

Vector3f SurfaceMap::fitted_normal(std::size_t i) const {
  const Vector3f p = grid_.points()[i];
  nearest_.clear();
  grid_.nearest(p, kFitNeighbors, nearest_);
  Vector3d mean = Vector3d::Zero();
  for (const auto& n : nearest_) mean += grid_.points()[n.index].cast<double>();
  mean /= static_cast<double>(nearest_.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& n : nearest_) {
    const Vector3d d = grid_.points()[n.index].cast<double>() - mean;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  Vector3d normal = solver.eigenvectors().col(0);
  if (normal.dot(p.cast<double>() - center_) < 0) normal = -normal;
  return normal.cast<float>();
}

MapSample SurfaceMap::at(const Vector3d& x) const {
  near_.clear();
  grid_.within(x.cast<float>(), static_cast<float>(radius_), near_);
  double total = 0;
  Vector3d mean = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  for (const std::uint32_t i : near_) {
    const double weight = 1 - (point(i) - x).squaredNorm() / (radius_ * radius_);
    total += weight;
    mean += weight * point(i);
    normal += weight * normals_[i].cast<double>();
  }
  if (total <= 0 || normal.norm() < 0.4 * total) return {};
  mean /= total;
  normal.normalize();
  return {x - normal.dot(x - mean) * normal, normal};
}

double SurfaceMap::distance(const Vector3d& x) const {
  nearest_.clear();
  grid_.nearest(x.cast<float>(), 1, nearest_);
  return std::sqrt(static_cast<double>(nearest_.front().squared_distance));
}

}  // namespace palpate
