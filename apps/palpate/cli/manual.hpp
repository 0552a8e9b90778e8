// The manual page and the completion for bash.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The manual page of a program, for man(1): its commands with all their options, as they are
/// registered, and what it returns.
[[nodiscard]] std::string manual_page(CLI::App& program);

/// What completes the program's commands, options and the names that options take, for bash; where
/// nothing else fits it completes names of files.
[[nodiscard]] std::string bash_completion(CLI::App& program);

}  // namespace palpate::app
