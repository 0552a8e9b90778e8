#pragma once

#include <functional>
#include <utility>

#include "palpate/base/driver_info.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

/// A driver with what `list` adds to it. Where that throws, the driver is not available, and misses
/// what the error says.
[[nodiscard]] inline DriverInfo listed(DriverInfo driver,
                                       const std::function<void(DriverInfo&)>& list) {
  try {
    list(driver);
  } catch (const Error& error) {
    driver.available = false;
    driver.missing = error.what();
  }
  return driver;
}

}  // namespace palpate
