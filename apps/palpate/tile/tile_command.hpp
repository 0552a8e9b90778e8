// The command tile.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate tile`.
struct TileCommand {
  std::vector<std::string> inputs;
  std::string out;
  std::string json;
  double scale = 1;
  bool force = false;
};

void add_tile_options(CLI::App& command, TileCommand& tile);

/// `palpate tile`. @throws UsageError, Error.
void tile(const TileCommand& tile);

}  // namespace palpate::app
