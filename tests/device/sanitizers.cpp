// What sanitizers are told where they are at work; nobody else calls this.

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions();

/// What a scheduler that hangs may still use is never freed.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:OpenHapticsSession::OpenHapticsSession\n";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
