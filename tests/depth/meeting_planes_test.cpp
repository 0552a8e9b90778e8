// Blocks beside creases and edges belong to one face, however neighbours err together.
#include <gtest/gtest.h>

#include "depth/noisy_frames.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr NoiseKind kKinds[] = {NoiseKind::independent, NoiseKind::blurred, NoiseKind::quantised};

// What a camera sees of a scene of flat faces, without noise.
class Truth {
 public:
  explicit Truth(const std::vector<Solid>& solids) : solids_(solids), image_(exact_image(solids)) {}

  [[nodiscard]] const std::vector<float>& image() const { return image_; }

  [[nodiscard]] Vector3d point(int column, int row) const {
    const Pinhole& p = kKinect.pinhole;
    const Vector3d ray((2 * column - p.cx) / p.fx, (2 * row - p.cy) / p.fy, 1);
    return image_[static_cast<std::size_t>(2 * row) * kKinect.width + 2 * column] * ray;
  }
  [[nodiscard]] Vector3d normal(int column, int row) const {
    const Vector3d x = point(column, row);
    Distance nearest{.value = HUGE_VAL};
    for (const Solid& solid : solids_) {
      const Distance distance = distance_and_normal(solid, x);
      if (std::abs(distance.value) < std::abs(nearest.value)) nearest = distance;
    }
    return nearest.gradient;
  }
  // Is another face `reach` blocks away that this one joins?
  [[nodiscard]] bool meets_another(int column, int row, int reach) const {
    const Vector3d here = normal(column, row);
    for (const int du : {-reach, 0, reach}) {
      for (const int dv : {-reach, 0, reach}) {
        const bool near = (point(column + du, row + dv) - point(column, row)).norm() < 0.03;
        if (near && normal(column + du, row + dv).dot(here) < 0.7) return true;
      }
    }
    return false;
  }

 private:
  std::vector<Solid> solids_;
  std::vector<float> image_;
};

// Of the blocks up to two from another face: the share whose normal is far from their own's.
double share_turned_away(const std::vector<Solid>& solids, NoiseKind noise) {
  const Truth truth(solids);
  int blocks = 0;
  int wrong = 0;
  for (std::uint64_t k = 0; k < 2; ++k) {
    DepthFrame frame;
    frame.camera = kKinect;
    frame.depth = noisy_image(truth.image(), {.kind = noise, .seed = 7}, k);
    DepthFilter filter;
    const FilteredDepth& points = filter.filter(frame, Eigen::Isometry3d::Identity());
    for (int row = 8; row < points.rows - 8; ++row) {
      for (int column = 8; column < points.columns - 8; ++column) {
        const std::size_t i = static_cast<std::size_t>(row) * points.columns + column;
        if (points.states[i] != BlockState::fitted) continue;
        if (!truth.meets_another(column, row, 2)) continue;
        ++blocks;
        if (points.normals[i].cast<double>().dot(truth.normal(column, row)) < 0.7) ++wrong;
      }
    }
  }
  EXPECT_GT(blocks, 500);
  return static_cast<double>(wrong) / blocks;
}

TEST(MeetingPlanes, AWallsFootIsNotTheTableBehindIt) {
  for (const NoiseKind noise : kKinds) EXPECT_LT(share_turned_away(table_and_wall(), noise), 0.01);
}

TEST(MeetingPlanes, FacesOfABoxEndAtItsEdges) {
  const std::vector<Solid> solids = {box({0, 0, 0.7}, 0.1, 0.6, 0.5)};
  for (const NoiseKind noise : kKinds) EXPECT_LT(share_turned_away(solids, noise), 0.08);
}

}  // namespace
}  // namespace palpate::test
