// The run of all methods: it repeats, and gives palpate's rows as table A has them.
#include <gtest/gtest.h>

#include "rivals/compare.hpp"
#include "rivals/compare_table.hpp"
#include "rivals/play_stream.hpp"
#include "sim/simulated_scene.hpp"

namespace palpate::rivals {
namespace {

CompareOptions some(int layouts, std::initializer_list<const char*> names) {
  CompareOptions options;
  for (const char* name : names) options.methods.push_back(method_named(name));
  options.bench.layouts = layouts;
  options.bench.first_layout = 601;
  options.bench.seeds = 1;
  options.bench.rows = {"static press"};
  return options;
}

TEST(Rivals, GiveTheSameTableTwiceAndForAnyNumberOfThreads) {
  CompareOptions options = some(2, {"ours", "terrain", "hexahedra", "mls"});
  options.threads = 1;
  const std::string alone = markdown_scores(compare(options).scores, options.methods);
  options.threads = 2;
  EXPECT_EQ(markdown_scores(compare(options).scores, options.methods), alone);
  EXPECT_NE(alone.find("| mls | "), std::string::npos);
}

TEST(Rivals, OursIsWhatTableAScores) {
  const CompareOptions options = some(1, {"ours", "ours-points"});
  const auto here = compare(options).scores.results;
  std::vector<accuracy::Contender> contenders = accuracy::all_contenders();
  contenders.resize(2);
  const auto there = accuracy::run_bench(options.bench, contenders).results;
  ASSERT_EQ(here.size(), 2u);
  ASSERT_EQ(there.size(), 2u);
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_EQ(here[i].score.force, there[i].score.force);
    EXPECT_EQ(here[i].score.normal, there[i].score.normal);
  }
}

TEST(Rivals, FeelEachFrameOfAStreamTenMillisecondsAfterItsStamp) {
  const SimulatedTable table = make_simulated_table();
  SimulatedCameraOptions camera;
  camera.T_world_camera = table.T_world_camera;
  camera.noise.kind = NoiseKind::none;
  std::vector<Eigen::Vector3d> hip;
  for (int i = 0; i < 100; ++i) {
    hip.emplace_back(table.free_patch + Eigen::Vector3d(0, 0, std::max(0.01 - 3e-4 * i, -0.003)));
  }
  const std::vector<Method> methods = {method_named("terrain"), method_named("graph+filter"),
                                       method_named("mls")};
  const Played played = play_stream({table.scene, camera, hip}, methods);
  EXPECT_EQ(played.swaps, (std::vector<std::size_t>{10, 44, 77}));
  for (const std::vector<Step>& steps : played.steps) {
    ASSERT_EQ(steps.size(), hip.size());
    EXPECT_FALSE(steps[30].touching);
    for (std::size_t i = 50; i < steps.size(); ++i) EXPECT_NEAR(steps[i].force.z(), 1.5, 0.15);
  }
}

}  // namespace
}  // namespace palpate::rivals
