#pragma once

#include <dlfcn.h>

#include <cstdlib>

namespace palpate::realtime {

/// The function that would have been called had this program not defined one of the same name.
template <class Function>
Function* next_symbol(const char* name) noexcept {
  void* found = dlsym(RTLD_NEXT, name);
  if (!found) std::abort();
  return reinterpret_cast<Function*>(found);
}

}  // namespace palpate::realtime
