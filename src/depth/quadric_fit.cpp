// Fits a quadric to the bent blocks around one.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "depth/quadric.hpp"

namespace palpate::depth {
namespace {

using Eigen::Matrix4d;
using Products = Quadric::Products;
using Terms = Quadric::Terms;

// Blocks to each side: 66 mm at 0.7 m, what is held in a hand, and half of it where that is more
// than one surface (judgement).
constexpr int kReaches[] = {kLargestReach, kLargestReach / 2};
// The second fit takes the blocks that lie on the first one. A third adds no more (measured).
constexpr int kPasses = 2;
constexpr int kStepsAcross = 16;       // of the first pass (judgement)
constexpr double kSamples = 256;       // blocks; half as many err twice as much (measured on balls)
constexpr double kFewestSamples = 30;  // of the first pass, too: three for each term (judgement)
// Share of the bent blocks around, as far as they may be of its surface, that it has to explain.
// With 0.9 normals of 18 kinds of shapes are 5 % worse (measured).
constexpr double kShare = 0.98;
constexpr int kFree = 9;        // terms, but for a factor
constexpr int kOfPlane = 3;     // terms that a plane has of them (derived)
constexpr int kPowers = 5;      // 0 to 4, of products of two terms
constexpr double kTiny = 1e-9;  // keeps matrices regular where blocks are in two rows (judgement)

// Powers of r, u and v in each term.
constexpr int kTerms[10][3] = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 2, 0}, {0, 1, 1},
                               {0, 0, 2}, {1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {2, 0, 0}};

// Sums of r^k u^j v^m over blocks, k + j + m <= 4.
struct Moments {
  double of[kPowers][kPowers][kPowers] = {};

  void add_line(const double (&line)[kPowers][kPowers], double v) {
    for (int k = 0; k < kPowers; ++k) {
      for (int j = 0; k + j < kPowers; ++j) {
        double sum = line[k][j];
        for (int m = 0; k + j + m < kPowers; ++m, sum *= v) of[k][j][m] += sum;
      }
    }
  }

  [[nodiscard]] double count() const { return of[0][0][0]; }
  [[nodiscard]] double product(int i, int j) const {
    const auto& s = kTerms[i];
    const auto& t = kTerms[j];
    return of[s[0] + t[0]][s[1] + t[1]][s[2] + t[2]];
  }
  [[nodiscard]] Products products() const {
    Products all;
    for (int i = 0; i < 10; ++i) {
      for (int j = 0; j < 10; ++j) all(i, j) = product(i, j);
    }
    return all;
  }
  // Products of the derivatives by r of the last four terms: 1, u, v, 2 r.
  [[nodiscard]] Matrix4d derivatives() const {
    constexpr int kTerm[] = {0, 1, 2, 6};       // the terms 1, u, v, r (derived)
    constexpr double kFactor[] = {1, 1, 1, 2};  // of the derivatives (derived)
    Matrix4d all;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) all(i, j) = kFactor[i] * kFactor[j] * product(kTerm[i], kTerm[j]);
    }
    return all;
  }
};

// Every `step`th block of every `step`th row, relative to the block.
struct Samples {
  int left, top, right, bottom;
  int step;
  int seen = 0;  // bent blocks whose depths may be of the block's surface
};

// Variance of a block that a quadric shows: the noise's, or what it leaves where that is more;
// nullopt where it is no better than the best plane, which leaves `plane`. What errs together,
// `shared` blocks, is one sample, and each term takes the power of one: of both sums of squares
// only n / shared are counted, and the terms beyond the plane's take so many times `shared` of the
// noise alone. That is an F test, whose limit does not grow with the assumed noise.
std::optional<double> tested_variance(double n, double plane, double quadric, double variance,
                                      double shared) {
  const double free = n - kFree * shared;
  if (!(free > 0)) return {};
  const double seen = std::max(variance, quadric / free);
  const double term = shared * seen;
  constexpr int kMore = kFree - kOfPlane;  // derived
  if (!exceeds_noise(plane - quadric - kMore * term, kMore, term, 1)) return {};
  return seen;
}

struct Fitting {
  const simd::FitInput& in;
  const BlockFits& fits;
  Quadric q;
  double square;                         // within which blocks lie on it, in units
  double slab;                           // from the block's depth, within which they may
  Products products = Products::Zero();  // of the terms, summed

  void add_line(const Samples& s, int v, Moments& moments, Samples& held) const;
  Moments gather(const Samples& s, Samples& held) const;
  std::optional<double> solve(const Moments& moments);
  [[nodiscard]] double left_by_plane(const Moments& moments) const;
  bool set_spread(double n, double variance);
  bool run(double variance, double correlation);
};

// Adds the bent blocks of a row that lie on the quadric. `held` grows by them.
void Fitting::add_line(const Samples& s, int v, Moments& moments, Samples& held) const {
  const int begin = in.table.first_column - q.column;
  const int end = std::min(s.right, begin + in.table.columns - 1);
  const float* const rho = in.blocks.rho + (q.row + v) * in.blocks.stride + q.column;
  const std::size_t row = fits.grid.index(q.column, q.row + v);
  const double y = static_cast<double>(v) / q.reach;
  const QuadricLine line(q.a, y);
  double sums[kPowers][kPowers] = {};
  for (int u = s.left; u <= end; u += s.step) {
    if (u < begin || !is_bent(fits, row + static_cast<std::size_t>(u))) continue;
    const double x = static_cast<double>(u) / q.reach;
    const double r = (rho[u] - q.rho) / q.unit;
    if (!(std::abs(r) <= slab)) continue;
    ++held.seen;
    if (q.side != 0 && !line.holds(x, r, q.side, square)) continue;
    double power = 1;
    for (int k = 0; k < kPowers; ++k, power *= r) {
      double term = power;
      for (int j = 0; k + j < kPowers; ++j, term *= x) sums[k][j] += term;
    }
    held.left = std::min(held.left, u);
    held.right = std::max(held.right, u);
  }
  if (sums[0][0] == 0) return;
  held.top = std::min(held.top, v);
  held.bottom = std::max(held.bottom, v);
  moments.add_line(sums, y);
}

Moments Fitting::gather(const Samples& s, Samples& held) const {
  const int begin = in.table.first_row - q.row;
  const int end = std::min(s.bottom, begin + in.table.rows - 1);
  Moments moments;
  held = {q.reach, q.reach, -q.reach, -q.reach, s.step};
  for (int v = s.top; v <= end; v += s.step) {
    if (v >= begin) add_line(s, v, moments, held);
  }
  return moments;
}

// Finds the quadric with the least sum of squares for a mean squared derivative of 1: its value
// over the derivative is how far a block is off along its ray. Blocks count by the square of their
// derivative, which falls to 0 at the rim. The first six terms have no errors, so they follow from
// the others. Returns the mean of the squares; nullopt where numbers are too large.
std::optional<double> Fitting::solve(const Moments& moments) {
  products = moments.products();
  products.diagonal().array() += kTiny * moments.count();
  const Eigen::Matrix<double, 6, 4> mixed = products.topRightCorner<6, 4>();
  const Eigen::Matrix<double, 6, 4> taken = products.topLeftCorner<6, 6>().ldlt().solve(mixed);
  const Matrix4d left = products.bottomRightCorner<4, 4>() - mixed.transpose() * taken;
  Matrix4d norm = moments.derivatives();
  norm.diagonal().array() += kTiny * norm.trace();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix4d> solver(left, norm);
  if (solver.info() != Eigen::Success) return {};
  const Eigen::Vector4d b = std::sqrt(moments.count()) * solver.eigenvectors().col(0);
  q.a << -taken * b, b;
  q.side = q.a[6] > 0 ? 1 : -1;
  if (!q.a.allFinite()) return {};
  return std::max(0.0, solver.eigenvalues()[0]);
}

// The sum of squares that the best plane leaves, after solve() for the same moments.
double Fitting::left_by_plane(const Moments& moments) const {
  const Eigen::Vector3d with_r = products.block<3, 1>(0, 6);
  return moments.product(6, 6) - with_r.dot(products.topLeftCorner<3, 3>().ldlt().solve(with_r));
}

// Sets the quadric's spread, from so many blocks of this variance, what they share included.
bool Fitting::set_spread(double n, double variance) {
  products += n * q.a * q.a.transpose();  // regular along a, too
  const Eigen::LLT<Products> root(products);
  if (root.info() != Eigen::Success) return false;
  q.spread = root.matrixL().solve(Products::Identity());
  q.spread *= std::sqrt(variance);
  return q.holds(0, 0, q.rho, square * q.unit * q.unit);
}

bool Fitting::run(double variance, double correlation) {
  const int coarse = std::max(1, 2 * q.reach / kStepsAcross);
  const int edge = -q.reach / coarse * coarse;
  Samples next{edge, edge, q.reach, q.reach, coarse};
  Samples held{};
  double n = 0;
  double plane = 0;
  std::optional<double> left;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Moments moments = gather(next, held);
    n = moments.count();
    if (n < kFewestSamples || n < kShare * held.seen) return false;
    left = solve(moments);
    if (!left) return false;
    if (pass + 1 == kPasses) plane = left_by_plane(moments);
    const int step = held.step;
    q.support = n * step * step;
    next = {std::max(held.left - step, -q.reach), std::max(held.top - step, -q.reach),
            std::min(held.right + step, q.reach), std::min(held.bottom + step, q.reach),
            std::max(1, static_cast<int>(std::sqrt(q.support / kSamples)))};
  }
  const double apart = correlation / held.step;  // blocks in between do not count
  const double excess = n * *left - (n - kFree) * variance;
  if (exceeds_noise(excess, n - kFree, variance, shared_error(apart))) return false;
  const auto tested = tested_variance(n, plane, n * *left, variance, shared_error(apart));
  return tested && set_spread(n, *tested * shared_error(apart, 1, n));
}

}  // namespace

std::optional<Quadric> fit_quadric(const simd::FitInput& input, const NoiseModel& noise,
                                   const BlockFits& fits, int column, int row) {
  const float rho = input.blocks.rho[row * input.blocks.stride + column];
  const double sigma = block_sigma(noise, rho);
  const SameSurface same(noise, fits.grid);
  for (const int reach : kReaches) {
    const double unit = rho * std::abs(fits.grid.step_x) * reach;
    const double variance = sigma * sigma / (unit * unit);
    const double slab = same.limit(rho, static_cast<float>(reach)) / unit;
    Fitting fitting{input, fits, {column, row, reach, rho, unit}, kOffFace * variance, slab};
    if (fitting.run(variance, noise.correlation)) return fitting.q;
  }
  return {};
}

}  // namespace palpate::depth
