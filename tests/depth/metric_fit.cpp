#include "depth/metric_fit.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr int kSizes = 6;
constexpr double kLargestBent = 2.0 / 3;  // of r_max

bool explained(double chi2, double degrees) {
  return degrees > 0 && chi2 <= degrees + 3 * std::sqrt(2 * degrees);
}

}  // namespace

Vector3d MetricFitter::point(int column, int row) const {
  const double rho = blocks_->rho[blocks_->at(column, row)];
  return Vector3d(blocks_->grid.x(column), blocks_->grid.y(row), 1) / rho;
}

std::vector<MetricFitter::Neighbor> MetricFitter::neighbors(int column, int row) const {
  const Vector3d middle = point(column, row);
  std::vector<Neighbor> near;
  for (int r = 0; r < blocks_->grid.rows; ++r) {
    for (int c = 0; c < blocks_->grid.columns; ++c) {
      const float rho = blocks_->rho[blocks_->at(c, r)];
      if (!(rho > 0)) continue;
      const double distance = (point(c, r) - middle).norm();
      if (distance > options_.largest) continue;
      const double sigma = depth::block_sigma(options_.noise, rho);
      near.push_back({distance, double(c - column), double(r - row), rho,
                      sigma * sigma * 4 / blocks_->counts[blocks_->at(c, r)]});
    }
  }
  std::sort(near.begin(), near.end(),
            [](const Neighbor& a, const Neighbor& b) { return a.distance < b.distance; });
  return near;
}

Eigen::VectorXd MetricFitter::basis(const Neighbor& n, int terms) {
  Eigen::VectorXd all(6);
  all << 1, n.u, n.v, n.u * n.u / 2, n.u * n.v, n.v * n.v / 2;
  return all.head(terms);
}

MetricFitter::Model MetricFitter::solve(const std::vector<Neighbor>& window, int terms) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
  for (const Neighbor& n : window) {
    const Eigen::VectorXd b = basis(n, terms);
    normal += b * b.transpose() / n.variance;
    right += b * n.rho / n.variance;
  }
  Model model;
  model.covariance = normal.completeOrthogonalDecomposition().pseudoInverse();
  model.terms = model.covariance * right;
  for (const Neighbor& n : window) {
    const double left = n.rho - basis(n, terms).dot(model.terms);
    model.chi2 += left * left / n.variance;
  }
  return model;
}

// Takes in, in order of distance, what lies on the surface.
MetricFitter::Model MetricFitter::grow_past_edge(std::vector<Neighbor> window,
                                                 std::vector<Neighbor> rest, Model model) const {
  const auto terms = static_cast<int>(model.terms.size());
  for (std::size_t begin = 0; begin < rest.size(); begin += 8) {
    const std::size_t end = std::min(begin + 8, rest.size());
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::VectorXd b = basis(rest[i], terms);
      const double spread = rest[i].variance + b.dot(model.covariance * b);
      const double off = rest[i].rho - b.dot(model.terms);
      if (off * off <= 4 * spread) window.push_back(rest[i]);
    }
    const Model next = solve(window, terms);
    if (next.covariance(0, 0) > 1.5 * model.covariance(0, 0)) break;
    model = next;
  }
  return model;
}

// The largest window that one surface explains.
MetricFitter::Grown MetricFitter::grow(const std::vector<Neighbor>& all) const {
  Grown grown;
  for (int k = 0; k < kSizes; ++k) {
    const double radius = options_.largest * std::pow(4.0, double(k) / (kSizes - 1) - 1);
    std::vector<Neighbor> window;
    for (const Neighbor& n : all) {
      if (n.distance <= radius) window.push_back(n);
    }
    if (window.size() < 8) continue;
    const auto count = static_cast<double>(window.size());
    const Model affine = solve(window, 3);
    const Model bent = solve(window, 6);
    if (explained(affine.chi2, count - 3) && affine.chi2 - bent.chi2 <= 12) {
      grown.model = affine;
    } else if (explained(bent.chi2, count - 6) && radius <= kLargestBent * options_.largest) {
      grown.model = bent;
    } else {
      grown.edge = !explained(bent.chi2, count - 6);
      break;
    }
    grown.window = window;
  }
  return grown;
}

MetricFit MetricFitter::fit(int column, int row) const {
  const std::vector<Neighbor> all = neighbors(column, row);
  const Grown grown = grow(all);
  MetricFit result;
  if (grown.window.empty()) return result;
  result.found = true;
  Model best = grown.model;
  if (grown.edge) {
    const auto inside = static_cast<std::ptrdiff_t>(grown.window.size());
    best = grow_past_edge(grown.window, {all.begin() + inside, all.end()}, best);
  }
  const depth::BlockGrid& grid = blocks_->grid;
  const double a = best.terms[1] / grid.step_x;
  const double b = best.terms[2] / grid.step_y;
  const Vector3d ray(grid.x(column), grid.y(row), 1);
  result.normal = -Vector3d(a, b, best.terms[0] - a * ray.x() - b * ray.y()).normalized();
  const double rho = blocks_->rho[blocks_->at(column, row)];
  const double sigma = depth::block_sigma(options_.noise, static_cast<float>(rho));
  result.position = ray / (std::abs(best.terms[0] - rho) > 4 * sigma ? rho : best.terms[0]);
  return result;
}

}  // namespace palpate::test
