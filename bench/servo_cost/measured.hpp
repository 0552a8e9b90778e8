#pragma once

#include <functional>
#include <optional>
#include <string>

namespace palpate::servo_cost {

/// Options of the programs that measure a servo's cost.
struct CostOptions {
  double seconds = 60;
  int pairs = 9;
  double pair_seconds = 3;
  std::optional<int> processor = {};
};

/// The main() of such a program: reads its arguments, leaves the servo's processor to it (and says
/// so), and calls `run`, which says whether targets were met. Returns 0, 1 where they were not, 2
/// for errors.
[[nodiscard]] int run_measured(const std::string& name, const std::string& description, int argc,
                               char** argv, const std::function<bool(const CostOptions&)>& run);

}  // namespace palpate::servo_cost
