#pragma once

#include <string>
#include <vector>

#include "any_cloud/score.hpp"

namespace palpate::any_cloud {

/// What the columns of the table hold, one line each.
[[nodiscard]] std::string legend();
[[nodiscard]] std::string header();

/// One line: medians and worst of a row's seeds.
[[nodiscard]] std::string table_line(const std::vector<Result>& seeds);

/// Every score as comma-separated values with a header line.
[[nodiscard]] std::string csv(const std::vector<Result>& results);

}  // namespace palpate::any_cloud
