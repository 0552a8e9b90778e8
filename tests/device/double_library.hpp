#pragma once

#include <dlfcn.h>

#include <Eigen/Core>
#include <string>

#include "palpate/base/error.hpp"

namespace palpate::test {

/// The tests' side of a library that stands for a vendor's: its functions fake_*.
class DoubleLibrary {
 public:
  explicit DoubleLibrary(const std::string& path)
      : library_(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {}

  template <class Function>
  [[nodiscard]] Function* find(const char* name) const {
    auto* const found = reinterpret_cast<Function*>(::dlsym(library_, name));
    if (found == nullptr) throw Error(std::string(name) + " is not in the double");
    return found;
  }
  void reset() const { find<void()>("fake_reset")(); }
  void flag(const char* name, bool on) const { find<void(bool)>(name)(on); }
  /// Where the hand is held, in the maker's units and axes.
  void place(double x, double y, double z) const {
    find<void(double, double, double)>("fake_place")(x, y, z);
  }
  /// What the motors hold, N, in the maker's axes.
  [[nodiscard]] Eigen::Vector3d force() const {
    Eigen::Vector3d told;
    find<void(double*)>("fake_force")(told.data());
    return told;
  }
  [[nodiscard]] bool is_open() const { return find<bool()>("fake_is_open")(); }

 private:
  void* library_;
};

}  // namespace palpate::test
