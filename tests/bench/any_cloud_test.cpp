#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "any_cloud/ablation.hpp"
#include "any_cloud/rows.hpp"
#include "any_cloud/score.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

Row row_named(const std::string& name) {
  const std::vector<Row> rows = all_rows();
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  EXPECT_NE(found, rows.end()) << name;
  return *found;
}

TEST(AnyCloud, HasAnIdealThatIsRightInEveryRow) {
  int rows = 0;
  for (const Row& row : all_rows()) {
    const HostileScene scene = make_scene(row, 1);
    if (!scene.truth) continue;
    const Trace ideal = touch_truth(scene);
    const Score found = score(scene, {ideal, {}}, ideal);
    EXPECT_EQ(found.ideal_off, 0) << row.name;
    EXPECT_EQ(found.in_free_air, 0) << row.name;
    EXPECT_EQ(found.faults, 0) << row.name;
    EXPECT_FALSE(found.lost > 0) << row.name;
    EXPECT_FALSE(found.highest > 0.05) << row.name;
    EXPECT_LT(found.energy, 0.05) << row.name;
    ++rows;
  }
  EXPECT_GT(rows, 10) << "whose truth is known";
}

TEST(AnyCloud, IsFeltAlikeInEveryUnit) {
  const Row row = row_named("closed torus");
  std::set<std::pair<double, double>> units;  // spacing, survey coordinate
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const HostileScene scene = make_scene(row, seed);
    if (!units.insert({scene.spacing, scene.cloud.origin.y()}).second) continue;
    const Score found = score(scene, touch(scene, {}), touch_truth(scene));
    EXPECT_LT(found.force_error, 0.01) << "spacing " << scene.spacing;
    EXPECT_NEAR(found.radius, kRadius, 0.3) << "spacing " << scene.spacing;
  }
  EXPECT_EQ(units.size(), 4);
}

struct Held {
  const char* row;
  double height;  // mean, s
};

TEST(AnyCloud, IsFeltWhereItWasRightAlready) {
  for (const Held& held :
       {Held{"noise 0", 0.001}, Held{"noise 1 view", 0.15}, Held{"plate 12 jitter", 0.005},
        Held{"gap 10", 0.005}, Held{"wedge 100 signs", 0.1}, Held{"small 5R noise 0", 0.01},
        Held{"density 1:10", 0.01}, Held{"hole 2", 0.01}, Held{"rod 2R", 0.02},
        Held{"closed capsule", 0.02}, Held{"partial sphere view", 0.01}}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const Result result = run_row(row_named(held.row), seed);
      ASSERT_TRUE(result.score) << result.refusal;
      const Score& found = *result.score;
      EXPECT_EQ(found.lost, 0) << held.row;
      EXPECT_EQ(found.in_free_air, 0) << held.row;
      EXPECT_EQ(found.wrong_side, 0) << held.row;
      EXPECT_EQ(found.faults, 0) << held.row;
      EXPECT_LT(found.step, 0.05) << held.row;
      EXPECT_LT(found.height, held.height) << held.row;
      EXPECT_LT(found.energy, 0.05) << held.row;
    }
  }
}

TEST(AnyCloud, LetsNoPokeThroughBumps) {
  for (const char* row : {"relief 3", "relief 4", "relief 6", "relief 10", "thread"}) {
    const Result result = run_row(row_named(row), 1);
    ASSERT_TRUE(result.score) << result.refusal;
    EXPECT_GT(result.score->pokes, 15) << row;
    EXPECT_EQ(result.score->passed, 0) << row;
    EXPECT_EQ(result.score->held, 0) << row;
  }
}

// A plane that is pressed two deep for ten ticks, after ten in free air.
struct Press {
  HostileScene scene;
  Rendered rendered;

  Press() {
    Draft draft(1);
    scene.truth = half_space(Vector3d::Zero(), Vector3d::UnitZ());
    scene.stiffness = kNewtonsPerSpacing;
    scene.deep = draft.deep;
    scene.clear = draft.clear;
    draft.hand.start({0, 0, 5});
    for (int i = 1; i < 20; ++i) draft.hand.tick({0, 0, i < 10 ? 5.0 : -2.0});
    scene.ticks = draft.hand.ticks;
    rendered.trace = touch_truth(scene);
  }
  [[nodiscard]] Score scored() const { return score(scene, rendered, touch_truth(scene)); }
};

TEST(AnyCloudScore, GivesNothingForThePerfectTrace) {
  const Score found = Press().scored();
  EXPECT_EQ(found.force_error, 0);
  EXPECT_EQ(found.force_ratio, 1);
  EXPECT_EQ(found.lost, 0);
  EXPECT_EQ(found.in_free_air, 0);
  EXPECT_NEAR(found.height, 0, 1e-5);
  EXPECT_NEAR(found.step, 0, 1e-12);
}

TEST(AnyCloudScore, CountsLostContactOnceItIsThrough) {
  Press press;
  for (const std::size_t i : {10, 11, 14, 15, 16, 17}) press.rendered.trace.force[i].setZero();
  const Score found = press.scored();
  EXPECT_NEAR(found.lost, 60, 1e-9);
  EXPECT_EQ(found.through, 1);
  EXPECT_NEAR(found.step, 1, 1e-12);
}

TEST(AnyCloudScore, CountsPokesThatPassAndHandsThatAreHeldOutside) {
  Press press;
  EXPECT_EQ(press.scored().pokes, 1);
  EXPECT_EQ(press.scored().passed, 0);
  EXPECT_EQ(press.scored().over, 0);
  for (std::size_t i = 12; i < 16; ++i) {  // where the hand is, 2 deep
    press.rendered.trace.force[i].setZero();
    press.rendered.trace.proxy[i] = press.scene.ticks[i].hand;
  }
  EXPECT_EQ(press.scored().passed, 1);
  EXPECT_EQ(press.scored().held, 0);
  press.scene.ticks[3].hand = Vector3d(0, 0, 9);
  press.rendered.trace.force[3] = Vector3d(0, 0, 2);
  press.rendered.trace.proxy[3] = Vector3d(0, 0, 5);
  EXPECT_EQ(press.scored().held, 0);  // by an outlier, farther than 4 spacings from the body
  press.rendered.trace.proxy[3] = Vector3d(0, 0, 3);
  const Score found = press.scored();
  EXPECT_EQ(found.held, 1);
  EXPECT_EQ(found.most_outside, 2);
  EXPECT_GT(found.over, 0);
}

TEST(AnyCloudScore, CountsForceInFreeAirAndAgainstTheIdeals) {
  Press press;
  press.rendered.trace.force[4] = Vector3d(0.06, 0, 0);
  press.rendered.trace.force[5] = Vector3d(0.04, 0, 0);
  press.rendered.trace.force[12] *= -1;
  const Score found = press.scored();
  EXPECT_EQ(found.in_free_air, 1);
  EXPECT_EQ(found.wrong_side, 1);
}

TEST(Ablation, PricesEachRefinementOnTheSameScenes) {
  std::vector<Row> rows = all_rows();
  std::erase_if(rows, [](const Row& row) { return row.family != "folded"; });
  ASSERT_FALSE(rows.empty());
  rows.resize(1);
  int done = 0;
  const std::vector<Price> prices = ablate(rows, 5, 2, {}, [&] { ++done; });
  EXPECT_EQ(done, 2);
  ASSERT_FALSE(prices.empty());
  int differ = 0;
  for (const Price& one : prices) {
    EXPECT_EQ(one.scenes, 2) << one.refinement;
    EXPECT_LE(one.better + one.worse, one.differ) << one.refinement;
    differ += one.differ;
  }
  EXPECT_GT(differ, 0);  // two folded sheets need the ones that tell sheets apart
  EXPECT_NE(price_table(prices).find("| " + prices[0].refinement + " | 2 |"), std::string::npos);
}

TEST(Ablation, SignTestIsOfASplitThatChanceMakes) {
  EXPECT_NEAR(sign_test(10, 0), 2.0 / 1024, 1e-9);
  EXPECT_NEAR(sign_test(1, 8), 2 * (1 + 9.0) / 512, 1e-9);
  EXPECT_EQ(sign_test(5, 5), 1);
  EXPECT_EQ(sign_test(0, 0), 1);
}

}  // namespace
}  // namespace palpate::any_cloud
