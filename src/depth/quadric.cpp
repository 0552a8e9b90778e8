// What a quadric shows of the blocks around its own.
#include "depth/quadric.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

using Terms = Quadric::Terms;

constexpr int kNear = 2;  // blocks to each side of one that give its slopes (judgement)

Terms terms(double u, double v, double r) {
  Terms t;
  t << 1, u, v, u * u, u * v, v * v, r, r * u, r * v, r * r;
  return t;
}

using Along = Eigen::Matrix<double, 10, 4, Eigen::RowMajor>;

// Squared lengths of a lower triangular matrix's products with four vectors.
Eigen::Array4d squares(const Quadric::Products& lower, const Along& of) {
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  for (int i = 0; i < 10; ++i) {
    Eigen::Array4d product = Eigen::Array4d::Zero();
    for (int j = 0; j <= i; ++j) product += lower(i, j) * of.row(j).transpose().array();
    sum += product.square();
  }
  return sum;
}

}  // namespace

bool Quadric::holds(int u, int v, double there, double square) const {
  const QuadricLine line(a, static_cast<double>(v) / reach);
  return line.holds(static_cast<double>(u) / reach, (there - rho) / unit, side,
                    square / (unit * unit));
}

bool Quadric::explains(const simd::BlockRows& blocks, const SameSurface& same, int u, int v) const {
  const float* const here = blocks.rho + (row + v) * blocks.stride + column + u;
  const float slab = same.limit(*here, kNear);
  Eigen::Array3d sums = Eigen::Array3d::Zero();
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  int count = 0;
  for (int y = -kNear; y <= kNear; ++y) {
    const QuadricLine line(a, static_cast<double>(v + y) / reach);
    for (int x = -kNear; x <= kNear; ++x) {
      const float there = here[y * blocks.stride + x];
      if (!(there > 0) || !(std::abs(there - *here) <= slab)) continue;
      const double at = static_cast<double>(u + x) / reach;
      const double r = (there - rho) / unit;
      const double slope = line.slope(at, r);
      const Eigen::Array3d along = slope * Eigen::Array3d(1, x, y);
      sums += line.value(at, r) * along;
      squares += (slope * along).square();
      ++count;
    }
  }
  const double sigma = block_sigma(same.noise, *here) / unit;
  // Where rims cut the 5 x 5, tilts share the mean's error.
  const double shared = std::max(shared_error(same.noise.correlation, 0, count), 1.0);
  return (sums.square() <= kOffFace * sigma * sigma * shared * squares).all();
}

std::optional<Quadric::Sight> Quadric::at(int u, int v) const {
  const double x = static_cast<double>(u) / reach;
  const double y = static_cast<double>(v) / reach;
  const QuadricLine line(a, y);
  const double c = line.c(x);
  const double b = line.b(x);
  const double square = b * b - 4 * line.a * c;
  if (!(square > 0)) return {};
  const double root = side * std::sqrt(square);  // the derivative by r
  const double r = b * root > 0 ? -2 * c / (b + root) : (root - b) / (2 * line.a);
  const double rx = -(a[1] + 2 * a[3] * x + a[4] * y + a[7] * r) / root;
  const double ry = -(a[2] + a[4] * x + 2 * a[5] * y + a[8] * r) / root;
  if (!std::isfinite(r)) return {};
  const Terms t = terms(x, y, r);
  Along all =
      Along::Zero();  // how a counts for the value over its derivative, along the ray, u and v
  all.col(0) = t;
  all.col(1) << 0, 1, 0, 2 * x, y, 0, rx, rx * x + r, rx * y, 2 * r * rx;
  all.col(2) << 0, 0, 1, 0, x, 2 * y, ry, ry * x, ry * y + r, 2 * r * ry;
  all.col(1) -= (a[7] + 2 * line.a * rx) / root * t;
  all.col(2) -= (a[8] + 2 * line.a * ry) / root * t;
  const Eigen::Array4d variances = squares(spread, all) / square;
  const double per_block = unit / reach;
  return Sight{rho + unit * r, rx * per_block, ry * per_block, unit * unit * variances[0],
               per_block * per_block * std::max(variances[1], variances[2])};
}

}  // namespace palpate::depth
