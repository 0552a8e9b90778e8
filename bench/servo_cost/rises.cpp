// Compares the times of steps of paired runs.
#include "servo_cost/rises.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate::servo_cost {

namespace {

constexpr double kMostRiseP50 = 0.10;  // share; judgement
constexpr double kMostRiseP99 = 0.20;  // share; judgement

}  // namespace

double quantile(const std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto last = static_cast<double>(values.size()) - 1;
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

void Rises::add(const ServoRun& with, const ServoRun& without) {
  const auto rise = [&](double share) {
    return quantile(with.computing, share) / quantile(without.computing, share) - 1;
  };
  p50_.push_back(rise(0.5));
  p99_.push_back(rise(0.99));
  lock_waits_ += with.lock_waits;
}

bool Rises::met() const {
  return p50() <= kMostRiseP50 && p99() <= kMostRiseP99 && lock_waits_ == 0;
}

std::string rises_head() {
  return "| against | p50 | p99 |\n|---|---|---|";
}

std::string row_of(const Rises& rises, std::string_view against) {
  return fmt::format("| {} | {:+.1f} % | {:+.1f} % |", against, 100 * rises.p50(),
                     100 * rises.p99());
}

}  // namespace palpate::servo_cost
