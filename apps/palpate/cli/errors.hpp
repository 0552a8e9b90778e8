// Exit codes and usage errors.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/base/error.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// Exit codes of the program.
enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,  ///< of the input or of the run
  kUsage = 2,    ///< the command line makes no sense
};

/// A command line that parses but makes no sense; the message names which part and what to write.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws UsageError with the text `what`, unless `good`.
inline void require(bool good, const char* what) {
  if (!good) throw UsageError(what);
}

/// The one of `names` that was meant by `word`, if it is only mistyped; empty: none is near.
[[nodiscard]] std::string meant(std::string_view word, const std::vector<std::string>& names);

/// "; did you mean torus?" of a word that should be one of `names`; empty: none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& names);

/// What `make` gives; an Error of it is followed by the one of `named` (things with a name) that
/// was meant by `word`. @throws Error.
template <class Named, class Make>
auto suggesting(std::string_view word, const Named& named, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    std::vector<std::string> names;
    for (const auto& each : named) names.emplace_back(each.name);
    throw Error(error.what() + did_you_mean(word, names));
  }
}

/// "; did you mean --radius?" of the first word on a command line that `program` or one of its
/// commands did not recognise; empty: nothing is near.
[[nodiscard]] std::string hint(const CLI::App& program);

}  // namespace palpate::app
