#include <gtest/gtest.h>

#include "accuracy/table.hpp"
#include "support/effort.hpp"

namespace palpate::accuracy {
namespace {

// Two frames of table A on a scene of their own; the bench takes eight. Two are too few for a
// median, hence the margin.
void expect_targets_met(const BenchOptions& options) {
  const std::vector<Contender> contenders = {all_contenders().front()};
  const BenchResults results = run_bench(options, contenders);
  int compared = 0;
  for (const Target& target : targets(options.noise)) {
    if (target.limit < 0) continue;
    const double median = spread(results, contenders.front().name, target).median;
    EXPECT_LE(std::abs(median), 1.2 * target.limit) << target.row << ", " << target.metric;
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

TEST(Accuracy, OfTheDefaultMeetsTableA) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  BenchOptions options;
  options.layout = 1;
  options.seeds = 2;
  options.first_seed = 1001;
  expect_targets_met(options);
}

TEST(Accuracy, OfTheDefaultMeetsTableAWhereNeighboursErrTogether) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  BenchOptions options;
  options.seeds = 2;
  options.first_seed = 2001;
  options.noise = NoiseKind::blurred;
  options.rows = {"plane slide", "sphere slide"};
  expect_targets_met(options);
}

}  // namespace
}  // namespace palpate::accuracy
