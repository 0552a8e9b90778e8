// The command tile.
#pragma once

#include <string>
#include <vector>

#include "palpate/io/files.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate tile`.
struct TileCommand {
  std::vector<std::string> inputs;
  std::string out;
  std::string json;
  ReadOptions reading;  ///< the scale
  bool force = false;
};

void add_tile_options(CLI::App& command, TileCommand& tile);

/// `palpate tile`. @throws UsageError, Error.
void tile(const TileCommand& tile);

}  // namespace palpate::app
