#include "io/laszip_library.hpp"

#include <dlfcn.h>

namespace palpate::io {

LaszipLibrary::LaszipLibrary(std::span<const std::string> names) {
  for (const std::string& name : names) {
    library_ = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library_ == nullptr) continue;
    if (find_all()) return;
    ::dlclose(library_);
    library_ = nullptr;
  }
}

LaszipLibrary::~LaszipLibrary() {
  if (library_ != nullptr) ::dlclose(library_);
}

template <class Function>
bool LaszipLibrary::find(const char* name, Function*& function) const {
  function = reinterpret_cast<Function*>(::dlsym(library_, name));
  return function != nullptr;
}

bool LaszipLibrary::find_all() {
  return find("laszip_create", create) && find("laszip_destroy", destroy) &&
         find("laszip_open_reader", open_reader) && find("laszip_close_reader", close_reader) &&
         find("laszip_get_point_pointer", get_point_pointer) &&
         find("laszip_read_point", read_point) && find("laszip_get_error", get_error);
}

}  // namespace palpate::io
