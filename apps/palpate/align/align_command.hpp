#pragma once

#include <string>

#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

/// The command line of `palpate align`.
struct AlignOptions {
  TouchChoices touch;  ///< sources, poses, --json and --picture; the rest is as `touch` has it
  std::string output;
};

void add_align_options(CLI::App& command, AlignOptions& options);

/// `palpate align`; `command` is what was parsed into `options`. @throws UsageError, Error.
void align_sources(const CLI::App& command, const AlignOptions& options);

}  // namespace palpate::app
