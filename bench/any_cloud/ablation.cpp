// Touches each scene with all refinements and without each of them in turn.
#include "any_cloud/ablation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "any_cloud/bench_run.hpp"
#include "refine/refinements.hpp"

namespace palpate::any_cloud {
namespace {

constexpr double kHardStep = 1;  // N in a tick: a click that nobody overlooks

std::vector<Touch> ways_without_each(const FieldOptions& field) {
  std::vector<Touch> ways{[=](const HostileScene& scene) { return touch(scene, field); }};
  for (const Refinement& one : refinements()) {
    PrepareOptions prepare;
    prepare.without = {std::string(one.name)};
    ways.emplace_back([=](const HostileScene& scene) { return touch(scene, field, prepare); });
  }
  return ways;
}

bool same(const Score& a, const Score& b) {
  const auto equal = [](double one, double other) {
    return one == other || (std::isnan(one) && std::isnan(other));
  };
  return equal(a.force_error, b.force_error) && equal(a.step, b.step) && equal(a.lost, b.lost) &&
         equal(a.height, b.height) && equal(a.in_free_air, b.in_free_air) &&
         equal(a.passed, b.passed) && equal(a.held, b.held);
}

/// Faults of a scene that a person notices.
double faults(const Score& score) {
  const double step = score.step > kHardStep ? 1 : 0;
  return score.passed + score.held + step;
}

void add(const Score& with, const Score& without, Price& price) {
  ++price.scenes;
  if (same(with, without)) return;
  ++price.differ;
  price.worse += faults(without) > faults(with) ? 1 : 0;
  price.better += faults(without) < faults(with) ? 1 : 0;
  price.passed += without.passed - with.passed;
  price.held += without.held - with.held;
}

}  // namespace

std::vector<Price> ablate(const std::vector<Row>& rows, std::uint64_t first_seed, int seeds,
                          const FieldOptions& field, const std::function<void()>& done) {
  const std::vector<Touch> ways = ways_without_each(field);
  std::vector<Price> prices;
  for (const Refinement& one : refinements())
    prices.push_back({.refinement = std::string(one.name)});
  for (const Row& row : rows) {
    for (int i = 0; i < seeds; ++i) {
      const std::vector<Result> results =
          run_row(row, first_seed + static_cast<std::uint64_t>(i), ways);
      for (std::size_t k = 0; k < prices.size(); ++k) {
        const auto& with = results.front().score;
        const auto& without = results[k + 1].score;
        if (with && without) add(*with, *without, prices[k]);
      }
      if (done) done();
    }
  }
  return prices;
}

double sign_test(int worse, int better) {
  const int n = worse + better;
  const int fewer = std::min(worse, better);
  double p = 0;
  for (int k = 0; k <= fewer; ++k) {
    const double ways = std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
    p += std::exp(ways - n * std::log(2.0));
  }
  return std::min(1.0, 2 * p);
}

std::string price_table(const std::vector<Price>& prices) {
  std::string table =
      "| without | scenes | differ | worse | better | p | passed | held |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Price& one : prices) {
    table += fmt::format("| {} | {} | {} | {} | {} | {:.2g} | {:+.0f} | {:+.0f} |\n",
                         one.refinement, one.scenes, one.differ, one.worse, one.better,
                         sign_test(one.worse, one.better), one.passed, one.held);
  }
  return table;
}

}  // namespace palpate::any_cloud
