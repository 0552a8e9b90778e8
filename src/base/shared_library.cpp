// Loads a library at run time, and separates one that is absent from one that is broken.
#include "base/shared_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <utility>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// Recognises the loader's message for a library that does not exist.
bool is_absent(const std::string& name, const std::string& reason) {
  return reason.starts_with(name + ": cannot open shared object file");
}

}  // namespace

SharedLibrary::SharedLibrary(const std::vector<std::string>& names, std::string remedy,
                             Unload unload)
    : remedy_(std::move(remedy)) {
  const int flags = RTLD_NOW | RTLD_LOCAL | (unload == Unload::never ? RTLD_NODELETE : 0);
  std::string reason;
  for (const std::string& name : names) {
    if (void* const loaded = ::dlopen(name.c_str(), flags)) {
      name_ = name;
      handle_ = {loaded, [](void* handle) { ::dlclose(handle); }};
      return;
    }
    const char* const error = ::dlerror();
    const std::string words = error == nullptr ? "no reason given" : error;
    if (!reason.empty() && (!is_absent(name_, reason) || is_absent(name, words))) continue;
    name_ = name;
    reason = words;
  }
  throw Error(fmt::format("the library {} cannot be loaded ({}). {}", name_, reason, remedy_));
}

SharedLibrary::Found SharedLibrary::operator[](const char* function) const {
  if (const Found found = find(function); found.address != nullptr) return found;
  throw Error(
      fmt::format("the library {} has no function {}: it is too old or a different library. {}",
                  name_, function, remedy_));
}

SharedLibrary::Found SharedLibrary::find(const char* function) const noexcept {
  return {::dlsym(handle_.get(), function)};
}

}  // namespace palpate
