#include "accuracy/drawn_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "accuracy/drawn_table.hpp"
#include "accuracy/image_outline.hpp"
#include "accuracy/strokes.hpp"
#include "accuracy/sweep.hpp"
#include "accuracy/truth_frame.hpp"

namespace palpate::accuracy {
namespace {

constexpr std::uint64_t kFirst = 1001;
constexpr std::uint64_t kCount = 50;

// All that a layout is made of, as numbers.
std::vector<double> numbers_of(std::uint64_t layout) {
  const TruthScene scene = draw_truth_scene(layout);
  std::vector<double> numbers;
  const auto add = [&](const auto& matrix) {
    for (const double value : matrix.reshaped()) numbers.push_back(value);
  };
  add(scene.camera.T_world_camera.matrix());
  for (const Solid& solid : scene.solids) {
    add(solid.T_world_solid.matrix());
    add(solid.size);
  }
  for (const Row& row : draw_rows(scene, layout)) {
    for (const Path& path : row.paths) {
      for (const Eigen::Vector3d& hip : path.hip) add(hip);
    }
  }
  return numbers;
}

// Is what the hand is in seen in the image, where it pushes into it?
bool seen(const TruthScene& scene, const DepthFrame& exact, const Eigen::Vector3d& hip) {
  const Distance at = distance_and_normal(scene, hip);
  const Eigen::Vector3d place = hip - at.value * at.gradient;
  const Outline pixel = project(scene.camera, {place});
  if (!inside_image(scene.camera, pixel, 1)) return false;
  const double depth = (scene.camera.T_world_camera.inverse() * place).z();
  const auto u = static_cast<std::size_t>(std::lround(pixel[0].x()));
  const auto v = static_cast<std::size_t>(std::lround(pixel[0].y()));
  const double shown = exact.depth[v * static_cast<std::size_t>(exact.camera.width) + u];
  return shown > depth - 0.008;
}

double deepest(const TruthScene& scene, const Path& path) {
  double least = 1;
  for (std::size_t i = path.begin; i < path.end; ++i) {
    least = std::min(least, distance_and_normal(scene, path.hip[i]).value);
  }
  return least;
}

TEST(DrawnScene, IsTheSameForTheSameNumberAndNoOther) {
  const std::vector<double> first = numbers_of(kFirst);
  EXPECT_EQ(first, numbers_of(kFirst));
  for (std::uint64_t i = 1; i < kCount; ++i) {
    const std::vector<double> other = numbers_of(kFirst + i);
    EXPECT_NE(first, other) << kFirst + i;
  }
}

TEST(DrawnScene, LetsEveryPathBeginInFreeAirAndTouchTheTruth) {
  for (std::uint64_t layout = kFirst; layout < kFirst + kCount; ++layout) {
    const TruthScene scene = draw_truth_scene(layout);
    for (const Row& row : draw_rows(scene, layout)) {
      ASSERT_FALSE(row.paths.empty());
      for (const Path& path : row.paths) {
        const double start = distance_and_normal(scene, path.hip.front()).value;
        // At the cloud's edge, where the truth goes on below, they begin behind the cloud or in it.
        EXPECT_TRUE(start > 0.004 || is_edge_row(row.name)) << row.name << ", layout " << layout;
        EXPECT_LT(deepest(scene, path), -4e-4) << row.name << ", layout " << layout;
      }
    }
  }
}

TEST(DrawnScene, ShowsWhatItsPathsTouch) {
  for (std::uint64_t layout = kFirst; layout < kFirst + kCount; ++layout) {
    const TruthScene scene = draw_truth_scene(layout);
    const DepthFrame exact = exact_frame(scene);
    int touching = 0;
    for (const Row& row : draw_rows(scene, layout)) {
      if (is_edge_row(row.name) || row.name.starts_with("crease")) continue;
      for (const Path& path : row.paths) {
        for (std::size_t i = path.begin; i < path.end; i += 20) {
          if (distance_and_normal(scene, path.hip[i]).value > 0) continue;
          ASSERT_TRUE(seen(scene, exact, path.hip[i])) << row.name << ", layout " << layout;
          ++touching;
        }
      }
    }
    EXPECT_GT(touching, 10) << "layout " << layout;
  }
}

TEST(DrawnScene, KeepsObjectsClearOfOneAnotherInTheImage) {
  for (std::uint64_t layout = kFirst; layout < kFirst + kCount; ++layout) {
    const TruthScene scene = draw_truth_scene(layout);
    std::vector<Outline> outlines;
    for (const TablePart part : {kSphere, kBox, kCylinder, kPlate}) {
      outlines.push_back(project(scene.camera, hull_above_table(scene.solids[part])));
      EXPECT_TRUE(inside_image(scene.camera, outlines.back(), 10)) << layout;
      for (std::size_t i = 0; i + 1 < outlines.size(); ++i) {
        EXPECT_TRUE(apart(outlines[i], outlines.back(), 8)) << layout;
      }
    }
    EXPECT_TRUE(is_free_table(scene, scene.slide_center, scene.slide_center)) << layout;
  }
}

TEST(DrawnTable, CountsFramesAboveATarget) {
  BenchResults results;
  for (const double normal : {0.05, 0.09, 0.11, 0.2}) {
    Result result;
    result.contender = kOrganised;
    result.row = "plane slide";
    result.score.normal = normal;
    results.results.push_back(result);
  }
  const Target normal{"plane slide", "", [](const Score& s) { return s.normal; }, {}, {}, ""};
  EXPECT_DOUBLE_EQ(share_above(results, kOrganised, normal, 0.1), 50);
  Contender contender;
  contender.name = kOrganised;
  EXPECT_NE(markdown_drawn(results, {contender}, NoiseKind::independent)
                .find("0.10 (0.20) / 0.000 (0.000) / 0.0 (0.0) | 50 / 0 / - |"),
            std::string::npos);
}

TEST(Sweep, FeelsAnExactPlaneExactly) {
  BenchOptions options;
  options.seeds = 1;
  options.noise = NoiseKind::none;
  options.rounding = 0;
  options.rows = {"plane 0.50-0.70 m"};
  const std::vector<Contender> contenders = {all_contenders()[0]};
  const BenchResults results = run_sweep(options, contenders);
  ASSERT_EQ(results.results.size(), 5U);  // bins of incidence
  for (const Result& result : results.results) {
    EXPECT_LT(result.score.normal, 0.01) << result.row;
    EXPECT_LT(std::abs(result.score.height), 0.01) << result.row;
    EXPECT_EQ(result.score.lost, 0) << result.row;
    EXPECT_LT(result.score.force, 0.01) << result.row;
  }
  EXPECT_EQ(results.results.back().score.normal,
            run_sweep(options, contenders).results.back().score.normal);
  const std::string table = markdown_sweep(results, kOrganised);
  EXPECT_NE(table.find("| plane, 0.5-0.7 m | 0.00 (0.00) / "), std::string::npos) << table;
  EXPECT_NE(table.find("| sphere, 0.35-0.5 m |  |"), std::string::npos) << table;
}

}  // namespace
}  // namespace palpate::accuracy
