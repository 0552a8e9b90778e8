#pragma once

#include <memory>
#include <string>
#include <vector>

#include "palpate/base/driver_info.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

/// A library that is loaded at run time, so that palpate builds and runs without it. Copies share
/// it.
class SharedLibrary {
 public:
  /// May the library be unloaded? Libraries of devices start threads that they leave behind.
  enum class Unload { with_the_last_copy, never };

  /// Loads the first of `names` that loads: file names as for the system's linker, or paths.
  /// `remedy`: where to get it, for messages.
  /// @throws Error with the reason why none loads; of several reasons, that of a library that is
  /// there but broken.
  SharedLibrary(const std::vector<std::string>& names, std::string remedy, Unload unload);

  /// A function of the library, for the pointer that it initialises.
  struct Found {
    void* address;
    template <class Function>
    operator Function*() const {  // NOLINT(google-explicit-constructor)
      return reinterpret_cast<Function*>(address);
    }
  };
  /// @throws Error when it has none of that name.
  [[nodiscard]] Found operator[](const char* function) const;
  /// The same of a function that older versions lack: null where it has none.
  [[nodiscard]] Found find(const char* function) const noexcept;

 private:
  std::string name_;
  std::string remedy_;
  std::shared_ptr<void> handle_;
};

/// `driver` with what `list(driver)` adds to it. Where that throws an Error, the driver is not
/// available, and misses what the error names.
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
