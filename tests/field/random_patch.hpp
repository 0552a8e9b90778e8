// Columns of random numbers, as a patch has them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "field/simd/sums.hpp"

namespace palpate::test {

// Two labels of two sources, of random numbers about where x is asked for.
class RandomPatch {
 public:
  explicit RandomPatch(unsigned seed, bool even) : random_(seed) {
    const std::array<std::uint32_t, 5> runs{0, 8, 12, 32, 36};
    std::ranges::copy(runs, columns_.run_begin);
    columns_.sources = 2;
    columns_.labels = 2;
    columns_.edges = true;
    columns_.uniform_radius = even ? 0.9 : 0;
    for (std::size_t i = 0; i < columns_.end(); ++i) add_point(even);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns_.position[axis] = position_[axis].data();
      columns_.normal[axis] = normal_[axis].data();
      columns_.edge_normal[axis] = edge_normal_[axis].data();
    }
    columns_.weight = weight_.data();
    columns_.confidence = confidence_.data();
    columns_.radius = radius_.data();
    columns_.inverse_r2 = inverse_r2_.data();
    columns_.edge_height = edge_height_.data();
    columns_.edge_share = edge_share_.data();
    slope_.resize(weight_.size());
    near_.resize(weight_.size());
    columns_.slope = slope_.data();
    columns_.near = near_.data();
  }

  const simd::Columns& columns() const { return columns_; }
  double draw(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Eigen::Vector3d draw3(double size) {
    return {draw(-size, size), draw(-size, size), draw(-size, size)};
  }

 private:
  using Column = std::vector<double>;
  using Column3 = std::array<Column, 3>;

  void add_point(bool even) {
    const auto add3 = [](Column3& to, const Eigen::Vector3d& v) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis].push_back(v[static_cast<Eigen::Index>(axis)]);
      }
    };
    add3(position_, draw3(0.9));
    add3(normal_, draw3(1));
    add3(edge_normal_, draw3(1));
    weight_.push_back(draw(0, 1));
    confidence_.push_back(draw(0, 1));
    radius_.push_back(even ? 0.9 : draw(0.6, 1.2));
    inverse_r2_.push_back(1 / (radius_.back() * radius_.back()));
    edge_height_.push_back(draw(-0.5, 0.5));
    edge_share_.push_back(std::max(0.0, draw(-1, 1)) * (draw(-1, 1) < 0 ? -1 : 1));
  }

  std::mt19937 random_;
  simd::Columns columns_{};
  Column3 position_, normal_, edge_normal_;
  Column weight_, confidence_, radius_, inverse_r2_, edge_height_, edge_share_, slope_;
  std::vector<std::uint32_t> near_;
};

}  // namespace palpate::test
