#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/live_options.hpp"
#include "apps/palpate/options/view_options.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

struct DemoOptions {
  std::string scene = "desk";
  std::optional<double> duration;    ///< s; unset: until Ctrl-C
  bool headless = false;             ///< opens no browser
  std::vector<std::string> devices;  ///< one a hand, as parse_device() takes them
  LiveOptions live;
  ViewOptions view;
};

void add_demo_options(CLI::App& command, DemoOptions& options);

/// Shows a scene that palpate makes itself on its page, explored by simulated hands, one unless
/// told otherwise, until somebody takes the tool. @throws Error as touch() does.
void demo(const DemoOptions& options);

}  // namespace palpate::app
