#pragma once

#include <string>
#include <vector>

namespace palpate::app {

/// Runs a program to its end, all that it writes in the file `output`, and returns its exit code;
/// 127: it is not there, 126: a signal ended it.
[[nodiscard]] int run_program(const std::vector<std::string>& words, const std::string& output);

}  // namespace palpate::app
