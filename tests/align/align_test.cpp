#include "palpate/align/align.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "palpate/base/error.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::make_points;
using test::TestPoint;
using testing::HasSubstr;

constexpr double kDegree = 0.017453292519943295;

Isometry3d pose(const Vector3d& place, double degrees, const Vector3d& axis) {
  Isometry3d result(Eigen::AngleAxisd(degrees * kDegree, axis.normalized()));
  result.translation() = place;
  return result;
}

// `faces` of three that meet in a corner, 120 mm long, sampled by chance with `noise` (m) along
// their normals; of each those points that `seen` wants, all of them moved by `moved`.
std::shared_ptr<const SurfacePoints> corner(
    unsigned seed, const Isometry3d& moved, int faces = 3, double noise = 0,
    const std::function<bool(const Vector3d&)>& seen = [](const Vector3d&) { return true; }) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(0, 0.12);
  std::normal_distribution<double> off(0, 1);
  std::vector<TestPoint> points;
  for (int i = 0; i < 500 * faces; ++i) {
    const Vector3d normal = Vector3d::Unit(i % faces);
    Vector3d place(along(random), along(random), along(random));
    place[i % faces] = 0;
    if (!seen(place)) continue;
    const Vector3d leaning = normal + 0.01 * Vector3d(off(random), off(random), off(random));
    points.push_back({moved * (place + noise * off(random) * normal),
                      moved.linear() * leaning.normalized(), 12e-3});
  }
  return std::make_shared<SurfacePoints>(make_points(points));
}

void expect_found(const AlignedSource& found, const Isometry3d& moved, double metres,
                  double degrees) {
  const Isometry3d left = found.T_aligned_rough * moved;
  EXPECT_LT(Eigen::AngleAxisd(left.linear()).angle(), degrees * kDegree);
  const Vector3d middle(0.04, 0.04, 0.04);
  EXPECT_LT((left * middle - middle).norm(), metres);
}

std::string refusal(const std::vector<RoughSource>& sources) {
  try {
    (void)align(sources);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Align, FindsASourceBack) {
  const Isometry3d moved = pose({0.02, -0.02, 0.015}, 9, {1, 2, -1});
  const auto found = align({{"a", corner(1, Isometry3d::Identity())}, {"b", corner(2, moved)}});
  expect_found(found[1], moved, 0.5e-3, 0.3);
  EXPECT_TRUE(found[0].T_aligned_rough.isApprox(Isometry3d::Identity(), 0));
  EXPECT_EQ(found[0].position_deviation, 0);
  EXPECT_GT(found[1].before.residual, 5e-3);
  EXPECT_LT(found[1].after.residual, 0.5e-3);
  EXPECT_GT(found[1].after.overlap, 0.9);
}

TEST(Align, FindsWhatSharesAThird) {
  const Isometry3d moved = pose({0.01, 0.01, -0.02}, 6, {0, 1, 1});
  const auto low =
      corner(3, Isometry3d::Identity(), 3, 0, [](const Vector3d& p) { return p.sum() < 0.14; });
  const auto high = corner(4, moved, 3, 0, [](const Vector3d& p) { return p.sum() > 0.08; });
  const auto found = align({{"low", low}, {"high", high}});
  expect_found(found[1], moved, 0.5e-3, 0.3);
  EXPECT_LT(found[1].after.overlap, 0.7);
}

TEST(Align, PlacesSeveralTogether) {
  const std::vector<Isometry3d> moved = {Isometry3d::Identity(),
                                         pose({0.02, 0, 0.01}, 5, {1, 0, 1}),
                                         pose({0, -0.02, 0.01}, 7, {0, 1, -1})};
  std::vector<RoughSource> sources;
  for (unsigned i = 0; i < 3; ++i) sources.push_back({std::to_string(i), corner(i, moved[i])});
  const auto found = align(sources);
  for (std::size_t i = 1; i < 3; ++i) expect_found(found[i], moved[i], 0.5e-3, 0.3);
}

TEST(Align, GivesTheSameAnswerAgain) {
  const std::vector<RoughSource> sources = {
      {"a", corner(1, Isometry3d::Identity(), 3, 1e-3)},
      {"b", corner(2, pose({0.02, 0, 0}, 5, {1, 1, 0}), 3, 1e-3)}};
  EXPECT_EQ(align(sources)[1].T_aligned_rough.matrix(), align(sources)[1].T_aligned_rough.matrix());
}

// Over many draws of the noise errors are what the deviations say, to a factor of two.
TEST(Align, TellsHowSureItIs) {
  double square = 0;
  double told = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto found = align({{"a", corner(100 + seed, Isometry3d::Identity(), 3, 1e-3)},
                              {"b", corner(200 + seed, Isometry3d::Identity(), 3, 1e-3)}});
    const Vector3d middle(0.04, 0.04, 0.04);
    square += (found[1].T_aligned_rough * middle - middle).squaredNorm() / 3;
    told += found[1].position_deviation * found[1].position_deviation;
  }
  EXPECT_GT(std::sqrt(told / square), 0.5);
  EXPECT_LT(std::sqrt(told / square), 3) << "the worst of three directions is told";
}

TEST(Align, RefusesWhatSlidesOrTurns) {
  const Isometry3d none = Isometry3d::Identity();
  EXPECT_THAT(refusal({{"a", corner(1, none, 1, 0.3e-3)}, {"bare", corner(2, none, 1, 0.3e-3)}}),
              HasSubstr("the overlap of 'bare' with the others leaves it free to"));
  EXPECT_THAT(refusal({{"a", corner(1, none, 2, 0.3e-3)}, {"edge", corner(2, none, 2, 0.3e-3)}}),
              HasSubstr("free to slide along"));
}

TEST(Align, RefusesWhatCannotBeAligned) {
  const auto good = corner(1, Isometry3d::Identity());
  EXPECT_THAT(refusal({{"a", good}}), HasSubstr("at least two sources, got 1"));
  EXPECT_THAT(refusal({}), HasSubstr("at least two sources, got 0"));
  EXPECT_THAT(refusal({{"a", good}, {"far", corner(2, pose({5, 0, 0}, 0, {1, 0, 0}))}}),
              HasSubstr("'far' does not overlap the sources before it"));
  EXPECT_THAT(refusal({{"a", good}, {"nothing", std::make_shared<SurfacePoints>()}}),
              HasSubstr("'nothing' has 0 points"));
  SurfacePoints bald = *good;
  bald.normals.clear();
  EXPECT_THAT(refusal({{"bald", std::make_shared<SurfacePoints>(bald)}, {"b", good}}),
              HasSubstr("'bald' has 0 points with a reliable normal"));
  SurfacePoints doubtful = *good;
  for (float& c : doubtful.confidences) c = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal({{"a", good}, {"doubtful", std::make_shared<SurfacePoints>(doubtful)}}),
              HasSubstr("'doubtful' has 0 points with a reliable normal"));
}

}  // namespace
}  // namespace palpate
