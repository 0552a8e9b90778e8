#pragma once

#include <string>
#include <vector>

#include "apps/palpate/options/source_options.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate info`.
struct InfoOptions {
  std::vector<std::string> clouds;
  ReadOptions reading;
  std::string json;
  std::string picture;  ///< of several clouds the first one's: numbered_path()
};

void add_info_options(CLI::App& command, InfoOptions& options);

/// `palpate info`. @throws UsageError, Error.
void info(const InfoOptions& options);

}  // namespace palpate::app
