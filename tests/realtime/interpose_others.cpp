// Output to a stream (std::ostream and fmt end here too, even when nothing is flushed yet),
// throwing, and clocks, which answer without a system call and would otherwise go unseen.
#include <sys/time.h>
#include <time.h>

#include <cstdarg>
#include <cstdio>
#include <typeinfo>

#include "realtime/next_symbol.hpp"
#include "realtime/watch.hpp"

namespace {

using palpate::realtime::next_symbol;
using palpate::realtime::note;
using palpate::realtime::Offence;

std::size_t (*next_fwrite)(const void*, std::size_t, std::size_t, FILE*) = nullptr;
int (*next_fputs)(const char*, FILE*) = nullptr;
int (*next_puts)(const char*) = nullptr;
int (*next_fputc)(int, FILE*) = nullptr;
int (*next_vfprintf)(FILE*, const char*, va_list) = nullptr;
int (*next_clock_gettime)(clockid_t, timespec*) = nullptr;
int (*next_gettimeofday)(timeval*, void*) = nullptr;
void (*next_throw)(void*, std::type_info*, void (*)(void*)) = nullptr;

template <class Function>
Function* counted(Offence offence, Function*& next, const char* name) {
  note(offence);
  if (!next) next = next_symbol<Function>(name);
  return next;
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): glibc's names
extern "C" {

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* file) {
  return counted(Offence::log, next_fwrite, "fwrite")(data, size, count, file);
}
int fputs(const char* text, FILE* file) {
  return counted(Offence::log, next_fputs, "fputs")(text, file);
}
int puts(const char* text) {
  return counted(Offence::log, next_puts, "puts")(text);
}
int fputc(int character, FILE* file) {
  return counted(Offence::log, next_fputc, "fputc")(character, file);
}
int vfprintf(FILE* file, const char* format, va_list arguments) {
  return counted(Offence::log, next_vfprintf, "vfprintf")(file, format, arguments);
}
int printf(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int written = vfprintf(stdout, format, arguments);
  va_end(arguments);
  return written;
}
int fprintf(FILE* file, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int written = vfprintf(file, format, arguments);
  va_end(arguments);
  return written;
}

// What the two above become where the compiler fortifies by default.
int __vfprintf_chk(FILE* file, int /*flag*/, const char* format, va_list arguments) {
  return vfprintf(file, format, arguments);
}
int __printf_chk(int /*flag*/, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int written = vfprintf(stdout, format, arguments);
  va_end(arguments);
  return written;
}
int __fprintf_chk(FILE* file, int /*flag*/, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int written = vfprintf(file, format, arguments);
  va_end(arguments);
  return written;
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  return counted(Offence::clock, next_clock_gettime, "clock_gettime")(clock, time);
}
int gettimeofday(timeval* time, void* zone) noexcept {
  return counted(Offence::clock, next_gettimeofday, "gettimeofday")(time, zone);
}

[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*destroy)(void*)) {
  counted(Offence::raise, next_throw, "__cxa_throw")(thrown, type, destroy);
  __builtin_unreachable();
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
