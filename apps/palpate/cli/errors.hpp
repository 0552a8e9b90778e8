#pragma once

#include <stdexcept>

namespace palpate::app {

/// What the program returns.
enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,  ///< of the input or of the run
  kUsage = 2,    ///< the command line makes no sense
};

/// A command line that parses but makes no sense; the message says which part and what to write.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws UsageError that says `what`, unless `good`.
inline void require(bool good, const char* what) {
  if (!good) throw UsageError(what);
}

}  // namespace palpate::app
