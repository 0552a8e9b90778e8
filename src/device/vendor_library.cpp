#include "device/vendor_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "palpate/base/error.hpp"

namespace palpate::device {

VendorLibrary::VendorLibrary(const std::string& name, const std::string& brought_by)
    : name_(name),
      brought_by_(brought_by),
      library_(::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (library_ != nullptr) return;
  const char* why = ::dlerror();
  throw Error(
      fmt::format("the library {} cannot be loaded ({}). {}; 'palpate doctor' tells what is "
                  "missing",
                  name_, why == nullptr ? "no reason given" : why, brought_by_));
}

void* VendorLibrary::address(const char* function) const {
  void* found = ::dlsym(library_, function);
  if (found != nullptr) return found;
  throw Error(fmt::format("the library {} has no {}: it is too old, or another one. {}", name_,
                          function, brought_by_));
}

}  // namespace palpate::device
