#pragma once

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "support/rates.hpp"

namespace palpate::test {

/// A hand that goes from one random place to the next, each way at its own speed of 1 cm/s to 2
/// m/s, and jitters: some of its ways end in the solid, some go through everything.
class RandomHand {
 public:
  /// `size`: the hand stays within about this of the origin, m; it starts at twice that above.
  RandomHand(unsigned seed, double size) : random_(seed), size_(size), place_(0, 0, 2 * size) {}

  [[nodiscard]] Eigen::Vector3d next() {
    if ((goal_ - place_).norm() < 1e-3) {
      goal_ = size_ * vector();
      speed_ = std::pow(10.0, -2 + 1.15 * (1 + uniform_(random_)));
    }
    const Eigen::Vector3d way = goal_ - place_;
    place_ += way * std::min(1.0, speed_ * kTick / way.norm());
    return place_ + 2e-5 * vector();
  }

 private:
  Eigen::Vector3d vector() {
    const double x = uniform_(random_);
    const double y = uniform_(random_);
    return {x, y, uniform_(random_)};
  }
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
  double size_;
  double speed_ = 0.1;
  Eigen::Vector3d place_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();
};

}  // namespace palpate::test
