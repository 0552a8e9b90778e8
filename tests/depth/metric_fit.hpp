#pragma once

#include <Eigen/Dense>
#include <vector>

#include "depth/blocks.hpp"

namespace palpate::test {

struct MetricFitOptions {
  NoiseModel noise;
  double largest = 0.024;  ///< r_max, m; windows go from a quarter of it in equal ratios
};

/// A place and a normal, sensor frame.
struct MetricFit {
  bool found = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// The noise-sized fit in its slow, first form, which needs neither
/// tables nor rectangles: all blocks within a metric radius, weighted by their noise, in a window
/// that grows while a plane or a paraboloid explains it; past that only blocks that lie on it.
class MetricFitter {
 public:
  MetricFitter(const depth::Blocks& blocks, const MetricFitOptions& options)
      : blocks_(&blocks), options_(options) {}

  [[nodiscard]] MetricFit fit(int column, int row) const;

 private:
  struct Neighbor {
    double distance, u, v, rho, variance;
  };
  /// Weighted least squares over the first `count`; the first three terms or all six.
  struct Model {
    Eigen::VectorXd terms;
    Eigen::MatrixXd covariance;
    double chi2 = 0;
  };

  struct Grown {
    std::vector<Neighbor> window;
    Model model;
    bool edge = false;  ///< what stopped it
  };

  [[nodiscard]] Eigen::Vector3d point(int column, int row) const;
  [[nodiscard]] std::vector<Neighbor> neighbors(int column, int row) const;
  static Eigen::VectorXd basis(const Neighbor& n, int terms);
  static Model solve(const std::vector<Neighbor>& window, int terms);
  [[nodiscard]] Grown grow(const std::vector<Neighbor>& all) const;
  [[nodiscard]] Model grow_past_edge(std::vector<Neighbor> window, std::vector<Neighbor> rest,
                                     Model model) const;

  const depth::Blocks* blocks_;
  MetricFitOptions options_;
};

}  // namespace palpate::test
