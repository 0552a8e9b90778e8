#include "device/target_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(Playback, IsStraightBetweenRowsAndRestsBeforeAndAfterThem) {
  Playback way({{1, {0, 0, 0}}, {1.5, {0.1, 0, 0}}, {3.5, {0.1, 0.4, 0}}});
  EXPECT_EQ(way.at(-1).position, Vector3d(0, 0, 0));
  EXPECT_NEAR((way.at(1.25).position - Vector3d(0.05, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((way.at(2).position - Vector3d(0.1, 0.1, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(way.at(9).position, Vector3d(0.1, 0.4, 0));
  EXPECT_EQ(way.end(), 3.5);
  way.rewind();
  EXPECT_NEAR((way.at(1.25).position - Vector3d(0.05, 0, 0)).norm(), 0, 1e-15);
}

TEST(Playback, OneRowIsAPlaceAndNoRowIsNone) {
  Playback place({{2, {1, 2, 3}}});
  EXPECT_EQ(place.at(0).position, Vector3d(1, 2, 3));
  EXPECT_EQ(place.at(5).position, Vector3d(1, 2, 3));
  EXPECT_TRUE(Playback().empty());
}

TEST(Playback, TurnsAndOpensEvenlyBetweenRows) {
  const auto turned = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY()));
  };
  Trajectory rows(2);
  rows[0].time = 1;
  rows[0].orientation = turned(0.2);
  rows[0].opening = 0.01;
  rows[1].time = 3;
  rows[1].orientation = turned(1);
  rows[1].opening = 0.03;
  Playback way(rows);
  EXPECT_NEAR(way.at(0).orientation.angularDistance(turned(0.2)), 0, 1e-12);
  EXPECT_NEAR(way.at(1.5).orientation.angularDistance(turned(0.4)), 0, 1e-12);
  EXPECT_NEAR(way.at(1.5).opening, 0.015, 1e-15);
  EXPECT_EQ(way.at(4).opening, 0.03);
}

using Eigen::Vector3d;

constexpr double kGlideStep = 1e-3;  // s

struct Told {
  double stamp = 0;  // s, on the sender's clock
  double heard = 0;  // s, on the listener's
};

// The speed at every step of a motion along x at 0.1 m/s, told at these times.
std::vector<double> speeds(TargetInterpolator& glide, const std::vector<Told>& told, double end) {
  std::vector<double> found;
  std::size_t next = 0;
  double before = glide.at(0).x();
  for (int i = 1; i * kGlideStep <= end; ++i) {
    const double time = i * kGlideStep;
    for (; next < told.size() && told[next].heard <= time; ++next) {
      glide.go({0.1 * told[next].stamp, 0, 0}, told[next].stamp, time);
    }
    const double x = glide.at(time).x();
    found.push_back((x - before) / kGlideStep);
    before = x;
  }
  return found;
}

class TargetInterpolatorAtRate : public testing::TestWithParam<double> {};

TEST_P(TargetInterpolatorAtRate, MakesAnEvenMotionOfEvenPlaces) {
  std::vector<Told> told;
  for (int i = 0; i < GetParam(); ++i) told.push_back({i / GetParam(), i / GetParam() + 1e-6});
  TargetInterpolator glide;
  glide.rest(Vector3d::Zero(), 0);
  const std::vector<double> found = speeds(glide, told, 1 - kGlideStep);
  for (std::size_t i = 500; i < found.size(); ++i) ASSERT_NEAR(found[i], 0.1, 0.01) << i;
  EXPECT_NEAR(glide.interval(), 1 / GetParam(), 0.02 / GetParam());
  // Late by a quarter of an interval to one and a quarter, and a step.
  EXPECT_NEAR(glide.at(0.999).x(), 0.0999, 0.1 * (1.25 / GetParam() + 1.5 * kGlideStep));
}

INSTANTIATE_TEST_SUITE_P(Rates, TargetInterpolatorAtRate, testing::Values(60.0, 125.0, 250.0));

TEST(TargetInterpolator, KeepsAnEvenMotionEvenWhilePlacesComeLate) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> late(0, 1.5e-3);
  std::vector<Told> told;
  for (int i = 0; i < 250; ++i) told.push_back({8e-3 * i, 8e-3 * i + late(random)});
  TargetInterpolator glide;
  glide.rest(Vector3d::Zero(), 0);
  const std::vector<double> found = speeds(glide, told, 1.9);
  for (std::size_t i = 500; i < found.size(); ++i) {
    ASSERT_GT(found[i], 0.05) << i;  // never a stop
    ASSERT_LT(found[i], 0.15) << i;
  }
}

TEST(TargetInterpolator, NeverGoesBeyondWhatItWasTold) {
  TargetInterpolator glide;
  glide.rest(Vector3d::Zero(), 0);
  glide.go({0.01, 0, 0}, 0, 0);
  glide.go({0.02, 0, 0}, 0.01, 0.01);
  for (int i = 10; i < 1000; ++i) ASSERT_LE(glide.at(i * kGlideStep).x(), 0.02);
  EXPECT_EQ(glide.at(1), Vector3d(0.02, 0, 0));
}

TEST(TargetInterpolator, APauseIsNoInterval) {
  TargetInterpolator glide;
  glide.rest(Vector3d::Zero(), 0);
  for (int i = 0; i < 50; ++i) glide.go({1e-4 * i, 0, 0}, 5e-3 * i, 5e-3 * i);
  const double interval = glide.interval();
  glide.go({0.02, 0, 0}, 10, 10);
  EXPECT_EQ(glide.interval(), interval);
  EXPECT_LT(glide.at(10 + kGlideStep).x(), 0.01) << "no jump after it";
  EXPECT_EQ(glide.at(10 + 1.3 * interval).x(), 0.02);
}

TEST(TargetInterpolator, StampsThatStandStillOrGoBackDoNoHarm) {
  TargetInterpolator glide;
  glide.rest(Vector3d::Zero(), 0);
  for (const double stamp : {5.0, 5.0, 4.0, -1e300, 1e300}) {
    glide.go(Vector3d::Constant(stamp > 0 ? 0.01 : 0), stamp, 0.1);
    EXPECT_TRUE(glide.at(0.105).allFinite());
    EXPECT_LE(glide.at(0.105).maxCoeff(), 0.01);
  }
  EXPECT_GE(glide.interval(), TargetInterpolator::kShortest);
  EXPECT_LE(glide.interval(), TargetInterpolator::kLongest);
}

}  // namespace

}  // namespace palpate
