#include "device/vendor_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

// As the loader says of a name that nothing has.
bool is_absent_library(const std::string& name, const std::string& words) {
  return words.starts_with(name + ": cannot open shared object file");
}

}  // namespace

VendorLibrary::VendorLibrary(const std::vector<std::string>& names, const std::string& brought_by)
    : brought_by_(brought_by) {
  std::string why;
  for (const std::string& name : names) {
    library_ = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library_ != nullptr) {
      name_ = name;
      return;
    }
    const char* told = ::dlerror();
    const std::string words = told == nullptr ? "no reason given" : told;
    if (!why.empty() && (!is_absent_library(name_, why) || is_absent_library(name, words)))
      continue;
    name_ = name;
    why = words;
  }
  throw Error(
      fmt::format("the library {} cannot be loaded ({}). {}; 'palpate doctor' tells what is "
                  "missing",
                  name_, why, brought_by_));
}

void* VendorLibrary::address(const char* function) const {
  void* found = ::dlsym(library_, function);
  if (found != nullptr) return found;
  throw Error(fmt::format("the library {} has no {}: it is too old, or another one. {}", name_,
                          function, brought_by_));
}

}  // namespace palpate::device
