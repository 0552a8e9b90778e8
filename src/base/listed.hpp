#pragma once

#include "palpate/base/driver_info.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

/// `driver` with what `list(driver)` adds to it. Where that throws an Error, the driver is not
/// available, and misses what the error says.
template <class List>
[[nodiscard]] DriverInfo listed(DriverInfo driver, const List& list) {
  try {
    list(driver);
  } catch (const Error& error) {
    driver.available = false;
    driver.missing = error.what();
  }
  return driver;
}

}  // namespace palpate
