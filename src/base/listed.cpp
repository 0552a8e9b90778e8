#include "base/listed.hpp"

#include "palpate/base/error.hpp"

namespace palpate {

DriverInfo listed(DriverInfo driver, const std::function<void(DriverInfo&)>& list) {
  try {
    list(driver);
  } catch (const Error& error) {
    driver.available = false;
    driver.missing = error.what();
  }
  return driver;
}

}  // namespace palpate
