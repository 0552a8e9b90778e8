#pragma once

#include "palpate/base/error.hpp"

namespace palpate {

/// A driver (CameraDriver, HapticDriver) with what `list` adds to it. Where that throws, the driver
/// is not available, and misses what the error says.
template <class Driver, class List>
[[nodiscard]] Driver listed(Driver driver, List list) {
  try {
    list(driver);
  } catch (const Error& error) {
    driver.available = false;
    driver.missing = error.what();
  }
  return driver;
}

}  // namespace palpate
