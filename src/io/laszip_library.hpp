#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palpate::io {

/// The few functions that we use of LASzip's C interface (laszip_api.h of LASzip 3), found at run
/// time. All return 0 when they succeed. The library stays loaded as long as this object.
class LaszipLibrary {
 public:
  using Handle = void*;

  /// Loads the first of `names` that can be loaded and has all functions; see loaded().
  explicit LaszipLibrary(std::span<const std::string> names);
  LaszipLibrary(const LaszipLibrary&) = delete;
  LaszipLibrary& operator=(const LaszipLibrary&) = delete;
  ~LaszipLibrary();

  [[nodiscard]] bool loaded() const { return library_ != nullptr; }

  int (*create)(Handle*) = nullptr;
  int (*destroy)(Handle) = nullptr;
  int (*open_reader)(Handle, const char* file, int* is_compressed) = nullptr;
  int (*close_reader)(Handle) = nullptr;
  int (*get_point_pointer)(Handle, std::byte** point) = nullptr;
  int (*read_point)(Handle) = nullptr;
  int (*get_error)(Handle, char** message) = nullptr;

 private:
  template <class Function>
  [[nodiscard]] bool find(const char* name, Function*& function) const;
  [[nodiscard]] bool find_all();

  void* library_ = nullptr;
};

}  // namespace palpate::io
