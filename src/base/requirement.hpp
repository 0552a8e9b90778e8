#pragma once

#include <fmt/core.h>

#include <cmath>
#include <string_view>

#include "palpate/base/error.hpp"

namespace palpate {

/// Checks the options of one thing: `const Requirement require{"guard"};`, then a call for each
/// number.
struct Requirement {
  std::string_view what;  ///< the thing

  /// @throws Error, such as "guard: slew (N/s) is -1; give a rate above 0", unless `good`.
  void operator()(bool good, std::string_view name, double value, std::string_view remedy) const {
    if (!good) throw Error(fmt::format("{}: {} is {}; {}", what, name, value, remedy));
  }

  /// The same of a number that has to be finite and above 0.
  void positive(std::string_view name, double value, std::string_view remedy) const {
    (*this)(std::isfinite(value) && value > 0, name, value, remedy);
  }

  /// The same of a number that has to be finite and not below 0.
  void not_negative(std::string_view name, double value, std::string_view remedy) const {
    (*this)(std::isfinite(value) && value >= 0, name, value, remedy);
  }
};

}  // namespace palpate
