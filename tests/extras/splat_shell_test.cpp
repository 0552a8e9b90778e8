// The shell of splats: what is kept, what goes, and that threads and order of work do not show.
#include "extras/splats/splat_shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/splat_scenes.hpp"
#include "support/thread_limit.hpp"

namespace palpate::test {
namespace {

double farthest(const SplatShell& shell, const SplatShape& shape) {
  double most = 0;
  for (const Eigen::Vector3f& p : shell.cloud.positions) {
    most = std::max(most, std::abs(shape.distance(p.cast<double>())));
  }
  return most / shell.spacing;
}

TEST(SplatShell, LiesInTheSurfaceWithNormalsToTheOutside) {
  const SplatShape sphere = splat_sphere();
  const SplatShell shell = shell_of(make_splats(sphere, {.floaters = 0}, 3));
  ASSERT_GT(shell.cloud.size(), 3000u);
  EXPECT_LT(farthest(shell, sphere), 1);
  std::size_t outward = 0;
  for (std::size_t i = 0; i < shell.cloud.size(); ++i) {
    outward += shell.cloud.normals[i].dot(shell.cloud.positions[i]) > 0 ? 1 : 0;
  }
  EXPECT_GT(outward, shell.cloud.size() * 99 / 100);  // the rest is seen into the shell
  EXPECT_LT(shell.without_normal, 0.01);
}

TEST(SplatShell, LeavesOutWhatFloatsAndWhatIsHidden) {
  const SplatShape sphere = splat_sphere();
  const SplatLook look{.floaters = 0.03, .hidden = 0.3};
  const std::vector<Splat> splats = make_splats(sphere, look, 4);
  const bool fills =
      std::ranges::any_of(splats, [](const Splat& splat) { return splat.position.norm() < 0.03F; });
  ASSERT_TRUE(fills);
  const SplatShell shell = shell_of(splats);
  EXPECT_GT(shell.pieces, 10u);
  EXPECT_LT(farthest(shell, sphere), 6);  // a hidden one would be 10 s deep, most floaters farther
}

TEST(SplatShell, IsTheSameOnAnyNumberOfThreads) {
  const std::vector<Splat> splats = make_splats(splat_box(), {.count = 20000, .hidden = 0.3}, 5);
  const SplatShell many = shell_of(splats);
  const ThreadLimit one(1);
  const SplatShell alone = shell_of(splats);
  EXPECT_EQ(many.cloud.positions, alone.cloud.positions);
  EXPECT_EQ(many.cloud.normals, alone.cloud.normals);
  EXPECT_EQ(many.cloud.colors, alone.cloud.colors);
  EXPECT_GT(many.cloud.size(), 1000u);
}

TEST(SplatShell, HasNoPointsWhereNothingIsOpaque) {
  std::vector<Splat> splats = make_splats(splat_sphere(), {.count = 500}, 6);
  EXPECT_TRUE(shell_of({}).cloud.empty());
  EXPECT_TRUE(shell_of(std::span(splats).first(1)).cloud.empty());  // a piece too small
  for (Splat& splat : splats) splat.opacity = 0;
  EXPECT_TRUE(shell_of(splats).cloud.empty());
}

}  // namespace
}  // namespace palpate::test
