#pragma once

#include <string>

#include "apps/palpate/touch_options.hpp"

namespace palpate::app {

/// The command line of `palpate info`.
struct InfoOptions {
  LoadOptions load;
  std::string json;
};

void add_info_options(CLI::App& command, InfoOptions& options);

/// `palpate info`. @throws UsageError, Error.
void info(const InfoOptions& options);

}  // namespace palpate::app
