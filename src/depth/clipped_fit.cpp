// Fits a plane to the blocks of a window that lie within given halves of the image.
#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "depth/window_fits.hpp"

namespace palpate::depth {
namespace {

using Eigen::Vector3d;

constexpr int kStrips = 8;            // strips that a window is cut into (judgement)
constexpr double kFewestBlocks = 25;  // blocks; fewer fit no plane (judgement)
// Times the variance of a quadratic term: the most that noise makes of three (docs/method.md 6.3)
constexpr double kBent = 12;

// Sums over blocks of the products of 1, u, v, u^2, u v, v^2, and of these times inverse depth.
struct Sums {
  Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();  // lower half
  Eigen::Matrix<double, 6, 1> r = Eigen::Matrix<double, 6, 1>::Zero();
  double rr = 0;
  double counts = 0;
};

// Sums of u^0 to u^4 over from ... to.
std::array<double, 5> powers(int from, int to) {
  const double n = to - from + 1;
  const double c = 0.5 * (from + to);
  const double cc = c * c;
  const double square = (n * n - 1) / 12;
  const double fourth = square * (3 * n * n - 7) / 20;
  return {n, n * c, n * (cc + square), n * c * (cc + 3 * square),
          n * (cc * cc + 6 * cc * square + fourth)};
}

// Adds the rectangle with these first and last blocks, counted from (column, row) of the table;
// inverse depths as the table has them.
void add_strip(const simd::WindowTable& table, int column, int row, const int (&u)[2],
               const int (&v)[2], Sums& sums) {
  const auto corner = [&](int k, int l) {
    return table.sums + simd::kWindowSums * (std::ptrdiff_t{row + v[l] + l} * (table.columns + 1) +
                                             column + u[k] + k);
  };
  const double* corners[] = {corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)};
  const auto sum = [&](int k) {
    return (corners[3][k] - corners[2][k]) - (corners[1][k] - corners[0][k]);
  };
  for (int k = 0; k < 6; ++k) sums.r[k] += sum(k);
  sums.rr += sum(6);
  sums.counts += sum(7);
  constexpr int kU[] = {0, 1, 0, 2, 1, 0};  // powers of u in the six terms
  constexpr int kV[] = {0, 0, 1, 0, 1, 2};  // powers of v
  const std::array<double, 5> of_u = powers(u[0], u[1]);
  const std::array<double, 5> of_v = powers(v[0], v[1]);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) sums.products(i, j) += of_u[kU[i] + kU[j]] * of_v[kV[i] + kV[j]];
  }
}

// Sums over strips, each as wide as its first and last rows allow.
Sums sum_strips(const simd::WindowTable& table, int column, int row, int reach_u, int reach_v,
                std::span<const HalfImage> halves) {
  const int top = -std::min(reach_v, row);
  const int bottom = std::min(reach_v, table.rows - 1 - row);
  const int height = (bottom - top + kStrips) / kStrips;
  Sums sums;
  for (int v = top; v <= bottom; v += height) {
    const int last = std::min(v + height - 1, bottom);
    double left = -std::min(reach_u, column);
    double right = std::min(reach_u, table.columns - 1 - column);
    for (const HalfImage& half : halves) {
      const double least = std::min(half.above(0, v), half.above(0, last));
      if (half.x > 0) left = std::max(left, std::ceil(-least / half.x));
      if (half.x < 0) right = std::min(right, std::floor(-least / half.x));
      if (half.x == 0 && least < 0) right = left - 1;
    }
    if (left > right) continue;
    add_strip(table, column, row, {static_cast<int>(left), static_cast<int>(right)}, {v, last},
              sums);
  }
  return sums;
}

// Moves the sums' origin from the table's middle to (u, v), and makes inverse depths relative to
// `plane`.
void move_to_block(double u, double v, const Vector3d& plane, Sums& s) {
  s.r[5] += v * (v * s.r[0] - 2 * s.r[2]);
  s.r[4] += u * v * s.r[0] - u * s.r[2] - v * s.r[1];
  s.r[3] += u * (u * s.r[0] - 2 * s.r[1]);
  s.r[2] -= v * s.r[0];
  s.r[1] -= u * s.r[0];
  s.products.triangularView<Eigen::StrictlyUpper>() = s.products.transpose();
  s.rr += plane.dot(s.products.topLeftCorner<3, 3>() * plane - 2 * s.r.head<3>());
  s.r -= s.products.leftCols<3>() * plane;
}

}  // namespace

std::optional<FacePlane> clipped_fit(const simd::FitInput& input, const NoiseModel& noise,
                                     const FacePlane& near, int reach_u, int reach_v,
                                     std::span<const HalfImage> halves) {
  const simd::WindowTable& table = input.table;
  const int column = near.column - table.first_column;
  const int row = near.row - table.first_row;
  Sums s = sum_strips(table, column, row, reach_u, reach_v, halves);
  const double n = s.products(0, 0);
  const double weights = s.counts - simd::kBlock * n;  // negative where there is a hole
  if (n < kFewestBlocks || weights < 0) return {};
  const Vector3d before = simd::kRhoUnits * Vector3d(near.rho, near.x, near.y);
  move_to_block(column - table.columns / 2, row - table.rows / 2, before, s);
  const Eigen::Matrix3d inverse = s.products.topLeftCorner<3, 3>().inverse();
  const Vector3d change = inverse * s.r.head<3>();
  const Vector3d plane = (before + change) / simd::kRhoUnits;
  const double sigma = simd::kRhoUnits * block_sigma(noise, static_cast<float>(plane[0]));
  const double variance = std::max(sigma * sigma * weights / (3 * n), 1. / 12);
  const double explained = s.r.head<3>().dot(change);
  if (exceeds_noise(s.rr - explained - (n - 3) * variance, n - 3, variance, input.shared))
    return {};
  const double bent = s.r.dot(s.products.ldlt().solve(s.r)) - explained;
  const double bend = variance * shared_error(noise.correlation, 2, n);
  if (!(bent <= kBent * bend)) return {};
  const double unit = variance / (simd::kRhoUnits * simd::kRhoUnits);
  const double mean = unit * shared_error(noise.correlation, 0, n) / n;
  const double slope = unit * shared_error(noise.correlation, 1, n);
  return FacePlane{near.column,
                   near.row,
                   plane[0],
                   plane[1],
                   plane[2],
                   mean + slope * (inverse(0, 0) - 1 / n),
                   slope * std::max(inverse(1, 1), inverse(2, 2)),
                   slope * inverse(0, 1),
                   slope * inverse(0, 2),
                   reach_u,
                   reach_v,
                   bent <= 3 * bend};
}

std::optional<double> left_by_paraboloid(const simd::FitInput& input, const FacePlane& near,
                                         int reach) {
  const simd::WindowTable& table = input.table;
  const int column = near.column - table.first_column;
  const int row = near.row - table.first_row;
  Sums s = sum_strips(table, column, row, reach, reach, {});
  if (s.counts < simd::kBlock * s.products(0, 0)) return {};
  const Vector3d plane = simd::kRhoUnits * Vector3d(near.rho, near.x, near.y);
  move_to_block(column - table.columns / 2, row - table.rows / 2, plane, s);
  const double left = s.rr - s.r.dot(s.products.ldlt().solve(s.r));
  return left / (simd::kRhoUnits * simd::kRhoUnits);
}

}  // namespace palpate::depth
