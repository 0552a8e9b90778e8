#pragma once

#include <memory>
#include <string>
#include <vector>

namespace palpate {

/// A library that is loaded at run time, so that palpate builds and runs without it. Copies share
/// it.
class SharedLibrary {
 public:
  /// Whether it may be unloaded. Libraries of devices start threads that they leave behind.
  enum class Unload { with_the_last_copy, never };

  /// Loads the first of `names` that loads: file names as the system's linker knows them, or paths.
  /// `remedy`: where to get it, for messages.
  /// @throws Error that says why none loads; of several reasons, that of a library that is there
  /// but broken.
  SharedLibrary(const std::vector<std::string>& names, std::string remedy, Unload unload);

  /// Sets `pointer` to a function of the library.
  /// @throws Error when it has none of that name.
  template <class Function>
  void find(const char* function, Function*& pointer) const {
    pointer = reinterpret_cast<Function*>(address(function));
  }

 private:
  [[nodiscard]] void* address(const char* function) const;

  std::string name_;
  std::string remedy_;
  std::shared_ptr<void> handle_;
};

}  // namespace palpate
