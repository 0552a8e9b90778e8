// The command replay.
#pragma once

#include <string>

#include "apps/palpate/options/touch_plan.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

struct ReplayCommand {
  std::string input;
  std::string json;
  std::string log;
  PagePlan page;
};

void add_replay_options(CLI::App& command, ReplayCommand& replay);

/// `palpate replay`: the exit code. @throws UsageError, Error.
[[nodiscard]] int replay(const ReplayCommand& command);

}  // namespace palpate::app
