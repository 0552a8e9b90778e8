#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

struct ReplayCommand {
  std::string input;
  std::string json;
  std::string log;
};

void add_replay_options(CLI::App& command, ReplayCommand& replay);

/// `palpate replay`: the exit code. @throws UsageError, Error.
[[nodiscard]] int replay(const ReplayCommand& command);

}  // namespace palpate::app
