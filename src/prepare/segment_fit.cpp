// Fits a plane and a quadric to the points of one segment.

#include "prepare/segment_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/neighborhoods.hpp"
#include "geometry/normals.hpp"
#include "prepare/height_groups.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A plane fits that leaves no more than this, of R or of the noise. Two segments half a spacing
// apart (0.2 R) leave 0.05 R where the other has one point in fifteen.
constexpr double kFlat = 0.05;      // judgement (docs/method.md 5.5)
constexpr double kNoisyFlat = 1.2;  // judgement (docs/method.md 5.5)

constexpr std::size_t kFewestInSegment = 5;  // points; with fewer confidence is 0; judgement
constexpr double kNearest = 1.75;      // spacings: the first two rings, seldom of a second segment
constexpr double kFlatNearest = 0.25;  // of the middle eigenvalue; judgement

constexpr int kTerms = 6;  // derived: terms of a quadric's height
using Terms = Eigen::Matrix<double, kTerms, 1>;

// Powers of y, and of x and y together, in each term; those of products number the moments.
constexpr std::array kPowerOfY{0, 0, 1, 0, 1, 2};
constexpr std::array kPower{0, 1, 1, 2, 2, 2};        // derived: as terms_at() lists them
using Two __attribute__((vector_size(16))) = double;  // one register, on any x86-64

Terms terms_at(const Vector3d& p) {
  return Terms(1, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
}

constexpr int kTiles = 16;        // along a window, at most; judgement
constexpr int kEnoughInTile = 6;  // points; tiles with fewer are left out; judgement
struct Plane {
  Vector3d mean = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  Vector3d variances = Vector3d::Zero();  // rising, m^2
};

Plane plane_of(const std::vector<Vector3d>& points) {
  Plane plane;
  if (points.size() < 3) return plane;
  const auto count = static_cast<double>(points.size());
  Matrix3d second = Matrix3d::Zero();
  for (const Vector3d& p : points) {
    plane.mean += p;
    for (int k = 0; k < 3; ++k) second.col(k) += p[k] * p;
  }
  plane.mean /= count;
  const Matrix3d scatter = second / count - plane.mean * plane.mean.transpose();
  const double size = scatter.trace();
  if (!(size > 0)) return plane;
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(scatter / size);
  plane.variances = (size * solver.eigenvalues()).cwiseMax(0.0);
  plane.normal = solver.eigenvectors().col(0);
  return plane;
}

double rms_residual(const Plane& plane, std::size_t points) {
  if (points <= 3) return 0;
  const auto count = static_cast<double>(points);
  return std::sqrt(plane.variances[0] * count / (count - 3));
}

double ramp(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0., 1.);
}

double planarity_of(const Plane& plane, std::size_t points) {
  const Vector3d& v = plane.variances;
  if (points < kFewestInSegment || !(v[1] > 0)) return 0;
  return ramp(v[1] / v[2], 0.03, 0.07) * (1 - ramp(v[0] / v[1], 0.4, 0.6));
}

// What a segment's fit may leave, of R or of the noise, and how far off it its points may be, of R.
constexpr double kSmooth = 0.03;      // judgement (docs/method.md 5.6)
constexpr double kNoisySmooth = 1.6;  // judgement (docs/method.md 5.6)
constexpr double kOnSegment = 0.12;   // judgement

double smooth_residual(double radius, double noise) {
  return std::max(kSmooth * radius, kNoisySmooth * noise);
}

}  // namespace

double flat_residual(double radius, double noise) {
  return std::max(kFlat * radius, kNoisyFlat * noise);
}

bool SegmentFit::is_smooth(double radius, double noise) const {
  return planarity >= kPlanar && (residual <= flat_residual(radius, noise) ||
                                  quadric_residual <= smooth_residual(radius, noise));
}

bool SegmentFit::is_segment(double radius, double noise) const {
  return points >= SegmentFitter::kEnough && planarity >= kPlanar &&
         quadric_residual <= smooth_residual(radius, noise) && off <= kOnSegment * radius;
}

/// Leaves the offsets on this side of a gap along the axis. False: there is none.
bool SegmentFitter::keep_own_group(const Vector3d& axis, double spacing) {
  if (offsets_.size() <= kFewestInSegment || axis.isZero()) return false;
  heights_.clear();
  for (const Vector3d& offset : offsets_) heights_.push_back(axis.dot(offset));
  const double gap = gap_in(heights_, spacing);
  if (std::isnan(gap)) return false;
  some_.clear();
  for (const Vector3d& offset : offsets_) {
    if ((axis.dot(offset) < gap) == (0 < gap)) some_.push_back(offset);
  }
  if (some_.size() < kFewestInSegment) return false;
  std::swap(some_, offsets_);
  return true;
}

/// The normal that the nearest points have, where they are flat.
Vector3d SegmentFitter::axis_of_nearest(double spacing, const Vector3d& fallback) {
  some_.clear();
  const double reach = kNearest * spacing;
  for (const Vector3d& offset : offsets_) {
    if (offset.squaredNorm() <= reach * reach) some_.push_back(offset);
  }
  if (some_.size() <= kFewestInSegment) return fallback;
  const Plane plane = plane_of(some_);
  const bool flat = plane.variances[0] < kFlatNearest * plane.variances[1];
  return flat && !plane.normal.isZero() ? plane.normal : fallback;
}

SegmentFit SegmentFitter::fit(const CellGrid& grid, const Eigen::Vector3f& center, double reach,
                              double spacing, double smooth) {
  near_.clear();
  grid.within(center, static_cast<float>(reach), near_);
  if (const std::size_t step = (near_.size() + kMostPoints - 1) / kMostPoints; step > 1) {
    for (std::size_t k = 0; k * step < near_.size(); ++k) near_[k] = near_[k * step];
    near_.resize((near_.size() + step - 1) / step);
  }
  return fit(grid, center, near_, reach, spacing, smooth);
}

SegmentFit SegmentFitter::fit(const CellGrid& grid, const Eigen::Vector3f& center,
                              std::span<const std::uint32_t> near, double reach, double spacing,
                              double smooth) {
  offsets_.clear();
  for (const auto i : near) offsets_.push_back((grid.points()[i] - center).cast<double>());
  SegmentFit fit = fit_offsets(reach);
  if (fit.quadric_residual > smooth && spacing > 0 && !fit.normal.isZero()) {
    Vector3d axis = axis_of_nearest(spacing, fit.normal);
    bool others = false;
    for (int round = 0; round < 2 && keep_own_group(axis, spacing); ++round) {
      others = true;
      axis = plane_of(offsets_).normal;
    }
    if (others) fit = fit_offsets(reach);
    fit.others = others;
  }
  return fit;
}

SegmentFit SegmentFitter::fit_offsets(double reach) {
  const Plane plane = plane_of(offsets_);
  SegmentFit fit;
  local_.clear();
  if (plane.normal.isZero()) return fit;
  fit.points = offsets_.size();
  fit.normal = plane.normal;
  fit.planarity = planarity_of(plane, fit.points);
  fit.quadric_residual = fit.residual = rms_residual(plane, fit.points);
  fit.off = std::abs(plane.normal.dot(plane.mean));
  fit.footprint = reach * std::sqrt(std::numbers::pi / static_cast<double>(fit.points));
  if (fit.points >= kEnough) subtract_quadric(reach, fit);
  return fit;
}

void SegmentFitter::subtract_quadric(double reach, SegmentFit& fit) {
  const Vector3d normal = fit.normal;
  const Vector3d u = normal.unitOrthogonal();
  const Vector3d v = normal.cross(u);
  local_.reserve(offsets_.size());
  std::array<Two, 8> sums = {};  // the moments
  std::array<Two, 3> right = {};
  double squares = 0;
  for (const Vector3d& offset : offsets_) {
    const Vector3d& p = local_.emplace_back(u.dot(offset), v.dot(offset), normal.dot(offset));
    const Two at = Two{p.x(), p.y()} / reach;
    const Two squares_of_both = at * at;
    const auto [x, y] = std::pair(at[0], at[1]);
    const auto [xx, yy] = std::pair(squares_of_both[0], squares_of_both[1]);
    const Two second = {xx, x * y};
    const Two low[] = {{1, x}, {y, xx}, {second[1], yy}};
    const Two high[] = {xx * at, yy * at, xx * second, yy * second, {yy * yy, 0}};
    for (int k = 0; k < 3; ++k) {
      sums[k] += low[k];
      right[k] += p.z() * low[k];
    }
    for (int k = 0; k < 5; ++k) sums[3 + k] += high[k];
    squares += p.z() * p.z();
  }
  Terms heights;
  Eigen::Matrix<double, kTerms, kTerms> matrix;
  for (int row = 0; row < kTerms; ++row) {
    heights[row] = right[row / 2][row % 2];
    for (int column = 0; column < kTerms; ++column) {
      const int power = kPower[row] + kPower[column];
      const int k = power * (power + 1) / 2 + kPowerOfY[row] + kPowerOfY[column];
      matrix(row, column) = sums[k / 2][k % 2];
    }
  }
  quadric_ = matrix.ldlt().solve(heights);
  squares = std::max(squares - quadric_.dot(heights), 0.);
  fit.quadric_residual = std::sqrt(squares / static_cast<double>(local_.size() - kTerms));
  fit.off = std::abs(quadric_[0]);
}

/// Mean over the tiles of (sum of residuals)^2 / number: the variance itself where they are
/// independent.
double SegmentFitter::tile_variance(double reach, double tile) const {
  struct Tile {
    double sum = 0;
    int count = 0;
  };
  std::array<Tile, std::size_t{kTiles * kTiles}> tiles;
  const auto index = [tile](double along) {
    return std::clamp(static_cast<int>(std::floor(along / tile)) + kTiles / 2, 0, kTiles - 1);
  };
  for (const Vector3d& p : local_) {
    Tile& at = tiles[static_cast<std::size_t>(index(p.x()) * kTiles + index(p.y()))];
    at.sum += p.z() - terms_at(p / reach).dot(quadric_);
    ++at.count;
  }
  double sum = 0;
  double used = 0;
  for (const Tile& at : tiles) {
    if (at.count < kEnoughInTile) continue;
    sum += at.sum * at.sum / at.count;
    ++used;
  }
  return used > 0 ? sum / used : 0;
}

}  // namespace palpate
