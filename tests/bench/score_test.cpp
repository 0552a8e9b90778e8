#include "accuracy/score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy/high_pass.hpp"
#include "accuracy/table.hpp"

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

std::vector<double> sine(double frequency, std::size_t n) {
  std::vector<double> signal(n);
  for (std::size_t i = 0; i < n; ++i) {
    signal[i] = std::sin(2 * kPi * frequency * static_cast<double>(i) * kTick);
  }
  return signal;
}

double amplitude(const std::vector<double>& signal) {
  double squares = 0;
  for (std::size_t i = 500; i + 500 < signal.size(); ++i) squares += signal[i] * signal[i];
  return std::sqrt(2 * squares / static_cast<double>(signal.size() - 1000));
}

TEST(HighPass, HasTheGainOfAButterworthRunTwice) {
  for (const double frequency : {2.0, 10.0, 20.0, 50.0, 200.0}) {
    // The bilinear transform bends frequencies; the cut-off is where it was asked for.
    const double ratio = std::tan(kPi * frequency * kTick) / std::tan(kPi * 20 * kTick);
    const double gain = std::pow(ratio, 4) / (1 + std::pow(ratio, 4));
    EXPECT_NEAR(amplitude(high_pass(sine(frequency, 4000), 20, 1000)), gain, 0.002) << frequency;
  }
}

TEST(HighPass, RemovesWhatIsConstant) {
  for (const double value : high_pass(std::vector<double>(300, 3.5), 20, 1000)) {
    EXPECT_NEAR(value, 0, 1e-9);
  }
  EXPECT_TRUE(high_pass({}, 20, 1000).empty());
}

TEST(LowPass, KeepsWhatTheHighPassTakesAway) {
  for (const double frequency : {2.0, 100.0, 400.0}) {
    const double ratio = std::tan(kPi * frequency * kTick) / std::tan(kPi * 400 * kTick);
    const double gain = 1 / (1 + std::pow(ratio, 4));
    EXPECT_NEAR(amplitude(low_pass(sine(frequency, 4000), 400, 1000)), gain, 0.002) << frequency;
  }
  for (const double value : low_pass(std::vector<double>(300, 3.5), 20, 1000)) {
    EXPECT_NEAR(value, 3.5, 1e-9);
  }
}

// A press of `n` ticks with constant ideal force.
struct Press {
  Path path;
  Trace ideal;
  Trace rendered;

  explicit Press(std::size_t n) {
    path.hip.assign(n, Vector3d(0, 0, -0.002));
    path.end = n;
    ideal.force.assign(n, Vector3d(0, 0, 1));
    ideal.proxy.assign(n, Vector3d::Zero());
    rendered = ideal;
  }
  [[nodiscard]] Score score() const {
    Scorer scorer;
    scorer.add(path, ideal, rendered, make_truth_scene());
    return scorer.score();
  }
};

TEST(Scorer, GivesNothingForAPerfectTrace) {
  const Score score = Press(500).score();
  EXPECT_EQ(score.normal, 0);
  EXPECT_EQ(score.force, 0);
  EXPECT_NEAR(score.ripple, 0, 1e-12);
  EXPECT_EQ(score.height, 0);
  EXPECT_EQ(score.lost, 0);
  EXPECT_EQ(score.step, 0);
}

TEST(Scorer, MeasuresAnglesForcesAndHeights) {
  Press press(400);
  const double tilt = 3 * kPi / 180;
  for (std::size_t i = 0; i < 200; ++i) {
    press.rendered.force[i] = Vector3d(std::sin(tilt), 0, std::cos(tilt));
    press.rendered.proxy[i] = Vector3d(0, 0, 0.001);
  }
  const Score score = press.score();
  EXPECT_NEAR(score.normal, 3 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(score.force, 2 * std::sin(tilt / 2) / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(score.height, 0.5, 1e-9);
  EXPECT_NEAR(score.step, 2 * std::sin(tilt / 2), 1e-12);
}

TEST(Scorer, MeasuresRippleAboveTwentyHertzAlone) {
  Press press(3000);
  const std::vector<double> fast = sine(100, 3000);
  const std::vector<double> slow = sine(1, 3000);
  for (std::size_t i = 0; i < 3000; ++i) {
    press.rendered.force[i].x() = 0.01 * fast[i] + 0.1 * slow[i];
  }
  EXPECT_NEAR(press.score().ripple, 0.01 / std::sqrt(2.0), 1e-4);
}

TEST(Scorer, CountsLostTicksAndPops) {
  Press press(100);
  for (const std::size_t i : {0, 1, 2, 10, 11, 20, 21, 22, 40, 41, 42, 43, 44}) {
    press.rendered.force[i] = Vector3d(0, 0, i % 2 == 0 ? 0 : 0.19);
  }
  const Score score = press.score();
  EXPECT_NEAR(score.lost, 0.13, 1e-12);
  EXPECT_EQ(score.pops, 2);  // ticks 0-2 come before anything was felt, 10-11 are too few
}

TEST(Scorer, LooksAtTicksWithIdealContactOnly) {
  Press press(400);
  for (std::size_t i = 0; i < 200; ++i) {
    press.ideal.force[i].setZero();
    press.rendered.force[i] = Vector3d(1, 0, 0);
  }
  const Score score = press.score();
  EXPECT_EQ(score.normal, 0);
  EXPECT_EQ(score.force, 0);
  EXPECT_NEAR(score.step, std::sqrt(2.0), 1e-12);
}

TEST(Scorer, IntegratesTheWorkDoneOnTheHand) {
  Press press(3);
  press.path.hip = {Vector3d(0, 0, 0), Vector3d(0, 0, 0.001), Vector3d(0, 0, 0.002)};
  EXPECT_NEAR(press.score().energy, 0.002, 1e-15);
}

TEST(Table, TakesMediansAndTheLargestMagnitude) {
  BenchResults results;
  for (const double height : {-0.08, 0.01, 0.03, 0.02}) {
    Score score;
    score.height = height;
    results.results.push_back({1, "balanced", "sphere slide", score});
  }
  int rows = 0;
  for (const Target& target : targets(NoiseKind::independent)) {
    if (target.row != "sphere slide" || target.metric != "height, mm") continue;
    ++rows;
    EXPECT_NEAR(spread(results, "balanced", target).median, 0.015, 1e-12);
    EXPECT_NEAR(spread(results, "balanced", target).worst, -0.08, 1e-12);
    EXPECT_TRUE(met(results, "balanced", target));
  }
  EXPECT_EQ(rows, 1);
}

}  // namespace
}  // namespace palpate::accuracy
