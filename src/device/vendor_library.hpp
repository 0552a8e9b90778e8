#pragma once

#include <string>
#include <vector>

namespace palpate::device {

/// A vendor's library, found at run time: whoever has none of its devices does without it. Never
/// unloaded, since such libraries leave threads behind.
class VendorLibrary {
 public:
  /// `names`: as the system's linker knows it, or a path; the first that loads is taken.
  /// `brought_by` says where to get it.
  /// @throws Error that says why none loads: what is there but broken before what is not there.
  VendorLibrary(const std::vector<std::string>& names, const std::string& brought_by);

  /// @throws Error when the library has no such function.
  template <class Function>
  void find(const char* function, Function*& pointer) const {
    pointer = reinterpret_cast<Function*>(address(function));
  }

 private:
  [[nodiscard]] void* address(const char* function) const;

  std::string name_;
  std::string brought_by_;
  void* library_ = nullptr;
};

}  // namespace palpate::device
