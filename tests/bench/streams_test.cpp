#include <gtest/gtest.h>

#include <cmath>

#include "streams/stream_table.hpp"
#include "support/effort.hpp"

namespace palpate::streams {
namespace {

// Short runs of the default: what table B asks of it, and nothing else of the bench.
std::vector<Result> run_all(const Options& options) {
  std::vector<Result> all;
  for (const Experiment& experiment : make_experiments(options)) {
    const std::vector<Result> results = run_experiment(experiment);
    all.insert(all.end(), results.begin(), results.end());
  }
  return all;
}

void expect_met(const std::vector<std::string>& names) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  Options options;
  options.seconds = 0.6;
  options.first_seed = 301;
  options.ours_alone = true;
  options.names = names;
  const std::vector<Result> results = run_all(options);
  int compared = 0;
  for (const Target& target : targets()) {
    for (const double value : values(results, target)) {
      // One short run scatters.
      EXPECT_LE(std::abs(value), 1.15 * target.limit) << target.experiment << ", " << target.metric;
      ++compared;
    }
  }
  EXPECT_GT(compared, 0);
}

TEST(Streams, PressMeetsTableB) {
  expect_met({"static press", "irregular frames, press"});
}

TEST(Streams, SphereSlideMeetsTableB) {
  expect_met({"sphere slide"});
}

TEST(Streams, SurfacesThatComeMeetTableB) {
  expect_met({"comes at"});
}

TEST(Streams, MovingAndSecondCamerasMeetTableB) {
  expect_met({"camera moves", "two cameras"});
}

// The measures on traces that are known.
Setup flat_press() {
  Setup setup = static_press({});
  setup.path.hip.resize(setup.path.begin + 1000, setup.path.hip.back());
  setup.path.end = setup.path.hip.size();
  return setup;
}

StreamTrace perfect(const Setup& setup) {
  StreamTrace trace;
  for (const Eigen::Vector3d& hip : setup.path.hip) {
    const Eigen::Vector3d on_table(hip.x(), hip.y(), std::max(0.0, hip.z()));
    trace.felt.proxy.push_back(on_table);
    trace.felt.force.push_back(accuracy::kStiffness * (on_table - hip));
    trace.normal.push_back(Eigen::Vector3d::UnitZ());
    trace.radius.push_back(0.01);
  }
  return trace;
}

TEST(Measures, GiveNothingForAPerfectTrace) {
  const streams::Setup setup = flat_press();
  StreamTrace trace = perfect(setup);
  for (std::size_t i = setup.path.begin; i < setup.path.end; i += 33) trace.swaps.push_back(i);
  const Measures m = measure(setup, trace, &trace.felt);
  EXPECT_EQ(m.jump, 0);
  EXPECT_NEAR(m.vibration, 0, 1e-12);
  EXPECT_EQ(m.force, 0);
  EXPECT_EQ(m.normal_sd, 0);
  EXPECT_NEAR(m.lag, 0, 1e-12);
  EXPECT_NEAR(m.radius, 10, 1e-9);
  EXPECT_EQ(m.contact, 1);
  EXPECT_EQ(m.pops, 0);
}

TEST(Measures, SeeAJumpAtASwap) {
  const streams::Setup setup = flat_press();
  StreamTrace trace = perfect(setup);
  const accuracy::Trace ideal = trace.felt;
  const std::size_t swap = setup.path.begin + 500;
  trace.swaps = {swap};
  for (std::size_t i = swap + 2; i < setup.path.end; ++i) {
    trace.felt.force[i].x() += 0.01;
    trace.felt.proxy[i].z() -= 0.001;
  }
  const Measures m = measure(setup, trace, &ideal);
  EXPECT_NEAR(m.jump, 0.01, 1e-12);
  EXPECT_NEAR(m.step, 0.01, 1e-12);
  EXPECT_NEAR(m.force, 0.01 * std::sqrt(0.498), 1e-6);
  EXPECT_NEAR(m.lag, 0.498, 1e-6);
  EXPECT_GT(m.vibration, 0);
}

TEST(Measures, SeeVibrationOfItsBandAndLostContact) {
  const streams::Setup setup = flat_press();
  StreamTrace trace = perfect(setup);
  const accuracy::Trace ideal = trace.felt;
  for (std::size_t i = 0; i < trace.felt.force.size(); ++i) {
    const double t = static_cast<double>(i) * kTick;
    trace.felt.force[i].x() += 0.01 * std::sin(2 * 3.14159265358979 * 100 * t);
    trace.felt.force[i].y() += 0.5 * std::sin(2 * 3.14159265358979 * 1 * t);
  }
  EXPECT_NEAR(measure(setup, trace, &ideal).vibration, 0.01 / std::sqrt(2.0), 2e-4);
  for (std::size_t i = 0; i < 4; ++i) trace.felt.force[setup.path.begin + 200 + i].setZero();
  const Measures m = measure(setup, trace, &ideal);
  EXPECT_EQ(m.pops, 1);
  EXPECT_NEAR(m.contact, 0.996, 1e-9);
}

}  // namespace
}  // namespace palpate::streams
