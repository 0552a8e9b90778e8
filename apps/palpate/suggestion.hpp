#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace palpate::app {

/// The one of `names` that was meant by `word`, if it is only mistyped; empty: none is near.
[[nodiscard]] std::string meant(std::string_view word, const std::vector<std::string>& names);

/// "; did you mean torus?" of a word that should be one of `names`; empty: none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& names);

/// "; did you mean --radius?" of the first word on a command line that `program` or one of its
/// commands did not know; empty: nothing is near.
[[nodiscard]] std::string hint(const CLI::App& program);

}  // namespace palpate::app
