// What sanitizers are told where they are at work; nobody else calls this.

#include <dlfcn.h>

// The sanitizers' own names for it.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __tsan_default_suppressions();
extern "C" int __lsan_is_turned_off();

/// OpenNI2 and its drivers are not ours: they unlock what is not locked, lock in changing orders,
/// and their threads race with each other.
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:OpenNI2\ndeadlock:OpenNI2\nrace:OpenNI2\nthread:OpenNI2\n"
         "race:libusb\nthread:libusb\n";
}

/// OpenNI2 unloads its drivers before all that they took is given back, so that the leaks have no
/// name any more: where it was loaded, leaks say nothing of us.
extern "C" int __lsan_is_turned_off() {
  return ::dlopen("libOpenNI2.so.0", RTLD_NOW | RTLD_NOLOAD) != nullptr ? 1 : 0;
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
