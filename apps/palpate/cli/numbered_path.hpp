#pragma once

#include <cstddef>
#include <string>

namespace palpate::app {

/// Where a file goes that each hand or cloud has: "forces.csv" of the first (0), then
/// "forces-2.csv", "forces-3.csv"; empty where it is.
[[nodiscard]] std::string numbered_path(const std::string& path, std::size_t hand);

}  // namespace palpate::app
