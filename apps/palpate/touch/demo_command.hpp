#pragma once

#include <string>

#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

struct DemoOptions {
  std::string scene = "desk";
  bool headless = false;    ///< opens no browser
  TouchChoices touch = {};  ///< but for its sources
};

void add_demo_options(CLI::App& command, DemoOptions& options);

/// Shows a scene that palpate makes itself on its page, explored by simulated hands, one unless
/// told otherwise, until somebody takes the tool. `command` is what was parsed into `options`.
/// @throws Error as touch() does.
void demo(const CLI::App& command, const DemoOptions& options);

}  // namespace palpate::app
