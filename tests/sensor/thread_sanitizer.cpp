// What the thread sanitizer is told where it is at work; nobody else calls this.

// The sanitizer's own name for it.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __tsan_default_suppressions();

/// OpenNI2 and its drivers are not ours: they unlock what is not locked, lock in changing orders,
/// and their threads race with each other.
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:OpenNI2\ndeadlock:OpenNI2\nrace:OpenNI2\nthread:OpenNI2\n"
         "race:libusb\nthread:libusb\n";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
