#include "prepare/window_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kTerms = 6;  // of a quadratic height
using Terms = Eigen::Matrix<double, kTerms, 1>;

constexpr int kTiles = 16;  // along a window, at most
constexpr int kEnoughInTile = 6;

Terms terms_at(const Vector3d& p) {
  Terms terms;
  terms << 1, p.y(), p.z(), p.y() * p.y(), p.y() * p.z(), p.z() * p.z();
  return terms;
}

// Axes by rising variance: the first is the normal.
Eigen::Matrix3d axes_of(const std::vector<Vector3d>& points) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) scatter += p * p.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
}

}  // namespace

WindowFit WindowFitter::fit(const CellGrid& grid, const Eigen::Vector3f& center, double reach,
                            double tile) {
  near_.clear();
  grid.within(center, static_cast<float>(reach), near_);
  if (near_.size() < kEnough) return {};
  const auto count = static_cast<double>(near_.size());
  local_.clear();
  Vector3d mean = Vector3d::Zero();
  for (const auto i : near_) local_.push_back((grid.points()[i] - center).cast<double>() / reach);
  for (const Vector3d& p : local_) mean += p;
  mean /= count;
  for (Vector3d& p : local_) p -= mean;
  const Eigen::Matrix3d axes = axes_of(local_);
  for (Vector3d& p : local_) p = axes.transpose() * p;
  const double variance = subtract_surface();
  WindowFit fit;
  fit.points = near_.size();
  fit.sigma = reach * std::sqrt(variance);
  fit.footprint = reach * std::sqrt(std::numbers::pi / count);
  if (tile > 0 && variance > 0) fit.shared = tile_variance(tile / reach) / variance;
  return fit;
}

// Leaves residuals for heights and returns their variance.
double WindowFitter::subtract_surface() {
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Terms right = Terms::Zero();
  for (const Vector3d& p : local_) {
    const Terms terms = terms_at(p);
    normal += terms * terms.transpose();
    right += terms * p.x();
  }
  const Terms surface = normal.colPivHouseholderQr().solve(right);
  double squares = 0;
  for (Vector3d& p : local_) {
    p.x() -= terms_at(p).dot(surface);
    squares += p.x() * p.x();
  }
  return squares / static_cast<double>(local_.size() - kTerms);
}

// Mean over the tiles of (sum of residuals)^2 / number: the variance itself where they are
// independent.
double WindowFitter::tile_variance(double tile) const {
  struct Tile {
    double sum = 0;
    int count = 0;
  };
  std::array<Tile, std::size_t{kTiles * kTiles}> tiles;
  const auto place = [tile](double along) {
    return std::clamp(static_cast<int>(std::floor(along / tile)) + kTiles / 2, 0, kTiles - 1);
  };
  for (const Vector3d& p : local_) {
    Tile& at = tiles[static_cast<std::size_t>(place(p.y()) * kTiles + place(p.z()))];
    at.sum += p.x();
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
