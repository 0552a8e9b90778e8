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

// Calls visit(points, block, column, row) for the fitted blocks of two frames.
template <class Visit>
void each_block(const Truth& truth, NoiseKind noise, const Visit& visit) {
  for (std::uint64_t k = 0; k < 2; ++k) {
    DepthFrame frame;
    frame.camera = kKinect;
    frame.depth = noisy_image(truth.image(), {.kind = noise, .seed = 7}, k);
    DepthFilter filter;
    const FilteredDepth& points = filter.filter(frame, Eigen::Isometry3d::Identity());
    for (int row = 8; row < points.rows - 8; ++row) {
      for (int column = 8; column < points.columns - 8; ++column) {
        const std::size_t i = static_cast<std::size_t>(row) * points.columns + column;
        if (points.states[i] == FilteredDepth::State::fitted) visit(points, i, column, row);
      }
    }
  }
}

// The share of blocks up to two from another face whose normal is far from their own face's.
double share_turned_away(const std::vector<Solid>& solids, NoiseKind noise) {
  const Truth truth(solids);
  int blocks = 0;
  int wrong = 0;
  each_block(truth, noise, [&](const FilteredDepth& points, std::size_t i, int column, int row) {
    if (!truth.meets_another(column, row, 2)) return;
    ++blocks;
    if (points.normals[i].cast<double>().dot(truth.normal(column, row)) < 0.7) ++wrong;
  });
  EXPECT_GT(blocks, 500);
  return static_cast<double>(wrong) / blocks;
}

struct Errors {
  double height = 0;  // m, root mean square
  double turn = 0;    // rad, root mean square
};

// The same of blocks more than two and up to six from another face.
Errors errors_beside_edges(const std::vector<Solid>& solids, NoiseKind noise) {
  const Truth truth(solids);
  Errors sums;
  int blocks = 0;
  each_block(truth, noise, [&](const FilteredDepth& points, std::size_t i, int column, int row) {
    if (truth.meets_another(column, row, 2) || !truth.meets_another(column, row, 6)) return;
    const Vector3d normal = truth.normal(column, row);
    const Vector3d off = points.positions[i].cast<double>() - truth.point(column, row);
    sums.height += std::pow(normal.dot(off), 2);
    sums.turn += (points.normals[i].cast<double>() - normal).squaredNorm();
    ++blocks;
  });
  EXPECT_GT(blocks, 500);
  return {std::sqrt(sums.height / blocks), std::sqrt(sums.turn / blocks)};
}

TEST(FaceFits, AWallsFootIsNotTheTableBehindIt) {
  for (const NoiseKind noise : kKinds) EXPECT_LT(share_turned_away(table_and_wall(), noise), 0.002);
}

TEST(FaceFits, FacesOfABoxEndAtItsEdges) {
  const std::vector<Solid> solids = {box({0, 0, 0.7}, 0.1, 0.6, 0.5)};
  for (const NoiseKind noise : kKinds) EXPECT_LT(share_turned_away(solids, noise), 0.08);
}

TEST(FaceFits, LieStraightBesideACrease) {
  constexpr Errors kMost[] = {{0.07e-3, 2.6e-3}, {0.41e-3, 8e-3}, {0.8e-3, 13e-3}};
  for (int k = 0; k < 3; ++k) {
    const Errors errors = errors_beside_edges(table_and_wall(), kKinds[k]);
    EXPECT_LT(errors.height, kMost[k].height) << k;
    EXPECT_LT(errors.turn, kMost[k].turn) << k;
  }
}

TEST(FaceFits, LieStraightBesideAnEdge) {
  const std::vector<Solid> solids = {box({0, 0, 0.7}, 0.1, 0.6, 0.5)};
  constexpr Errors kMost[] = {{0.052e-3, 13e-3}, {0.225e-3, 24e-3}, {0.385e-3, 30e-3}};
  for (int k = 0; k < 3; ++k) {
    const Errors errors = errors_beside_edges(solids, kKinds[k]);
    EXPECT_LT(errors.height, kMost[k].height) << k;
    EXPECT_LT(errors.turn, kMost[k].turn) << k;
  }
}

// A plane, and beside it what bends by 2 x 0.7 in inverse depth.
struct BentBesideAPlane {
  static double rho(double x, double y) { return std::max(plane(x, y), bent(x, y)); }
  static double plane(double x, double y) { return (1 + 0.8 * x + 0.1 * y) / 0.7; }
  static double bent(double x, double y) {
    return (1 - 0.9 * x + 0.7 * x * x + 0.05 * y + 0.35 * y * y) / 0.75;
  }
  static Vector3d normal(double x, double y) {
    const double a = -0.9 + 1.4 * x;
    const double b = 0.05 + 0.7 * y;
    return -Vector3d(a, b, 0.75 * bent(x, y) - a * x - b * y).normalized();
  }
};

TEST(FaceFits, ReachNoFartherThanTheyAreKnownToBeFlat) {
  using Scene = BentBesideAPlane;
  const Pinhole& p = kKinect.pinhole;
  DepthFrame frame;
  frame.camera = kKinect;
  for (int v = 0; v < kKinect.height; ++v) {
    for (int u = 0; u < kKinect.width; ++u) {
      const double z = 1 / Scene::rho((u - p.cx) / p.fx, (v - p.cy) / p.fy);
      frame.depth.push_back(static_cast<float>(z));
    }
  }
  frame.depth = noisy_image(frame.depth, {.kind = NoiseKind::independent, .seed = 7}, 0);
  DepthFilter filter;
  const FilteredDepth& points = filter.filter(frame, Eigen::Isometry3d::Identity());
  double squares = 0;
  int blocks = 0;
  for (int row = 8; row < points.rows - 8; ++row) {
    for (int column = 8; column < points.columns - 8; ++column) {
      const double x = (2 * column + 0.5 - p.cx) / p.fx;
      const double y = (2 * row + 0.5 - p.cy) / p.fy;
      const double side = 2 / p.fx;
      const bool bent = Scene::bent(x + 2 * side, y) > Scene::plane(x + 2 * side, y);
      const bool near = Scene::bent(x + 20 * side, y) < Scene::plane(x + 20 * side, y);
      if (!bent || !near) continue;
      const std::size_t i = static_cast<std::size_t>(row) * points.columns + column;
      squares += (points.normals[i].cast<double>() - Scene::normal(x, y)).squaredNorm();
      ++blocks;
    }
  }
  ASSERT_GT(blocks, 1000);
  EXPECT_LT(std::sqrt(squares / blocks), 12e-3);
}

}  // namespace
}  // namespace palpate::test
