// malloc and its kin, counted and handed on to glibc's own under the names it exports for that.
// operator new and delete of libstdc++ call these, as does everything that the libraries allocate.
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include "realtime/watch.hpp"

using palpate::realtime::note;
using palpate::realtime::Offence;

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): glibc's names
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) noexcept {
  note(Offence::allocate);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  note(Offence::allocate);
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  note(Offence::allocate);
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  note(Offence::allocate);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  note(Offence::allocate);
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  note(Offence::allocate);
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}

void free(void* block) noexcept {
  if (block) note(Offence::release);
  __libc_free(block);
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
