#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

double deviation(const std::vector<std::string>& cells) {
  double sum = 0;
  double square = 0;
  for (const std::string& cell : cells) sum += number(cell);
  const double mean = sum / static_cast<double>(cells.size());
  for (const std::string& cell : cells) square += (number(cell) - mean) * (number(cell) - mean);
  return std::sqrt(square / static_cast<double>(cells.size()));
}

TEST(Paper, Fig5HasThePapersSizesAndTimesBesideOurs) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  Shell shell;
  const Outcome outcome = shell.run("paper fig5 --repeats 1 --csv times.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto table = columns(shell.read("times.csv"));
  const std::vector<std::string> sizes = {"146000", "36000", "16000", "2500"};
  EXPECT_EQ(table["points"], sizes);
  EXPECT_EQ(table["paper_normals_ms"][0], "780");
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double wanted = number(sizes[i]);
    EXPECT_NEAR(number(table["points_here"][i]), wanted, 0.03 * wanted);
    EXPECT_GT(number(table["normals_ms"][i]), 0);
  }
  EXPECT_NE(outcome.out.find("780"), std::string::npos) << outcome.out;
}

TEST(Paper, Fig7ShowsWhatThePaperSaw) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  const Outcome outcome = shell.run("paper fig7 --duration 1 --csv press.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto table = columns(shell.read("press.csv"));
  ASSERT_EQ(table["t"].size(), 1000u);
  const double metaball = deviation(table["metaball_1_nx"]);
  const double averaged = deviation(table["metaball_4_nx"]);
  const double pointset = deviation(table["point-set_1_nx"]);
  EXPECT_LT(averaged, 0.8 * metaball) << "a history improves the metaball";
  EXPECT_LT(pointset, 0.6 * metaball) << "the point-set surface is smoother over time";
  EXPECT_LT(deviation(table["palpate_nx"]), 0.3 * pointset);
  for (const std::string& force : table["palpate_force"]) {
    EXPECT_NEAR(number(force), 500 * 4e-3, 0.3) << "4 mm deep";
  }
}

TEST(Paper, CommandLinesThatMakeNoSenseSayWhy) {
  Shell shell;
  for (const auto& [arguments, word] : std::initializer_list<std::pair<const char*, const char*>>{
           {"paper", "fig5 or fig7"},
           {"paper fig6", "fig6"},
           {"paper fig7 bunny.ply", "bunny.ply"},
           {"paper fig7 --duration 0", "0.1"},
           {"paper fig7 --picture -", "--picture"},
           {"paper fig5 --repeats 0", "repeats"}}) {
    const Outcome outcome = shell.run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace palpate::app
