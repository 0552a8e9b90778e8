// The command bag.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate bag`, whose parts are commands of their own.
struct BagCommand {
  std::string input;
  std::string output;  ///< of recover
  std::string json;
  bool check = false;
  CLI::App* info = nullptr;
  CLI::App* recover = nullptr;
};

void add_bag_options(CLI::App& command, BagCommand& bag);

/// `palpate bag`. @throws UsageError, Error.
void bag(const BagCommand& bag);

}  // namespace palpate::app
