#pragma once

#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "palpate/align/align.hpp"

namespace palpate::app {

/// The command line of `palpate align`.
struct AlignOptions {
  TouchChoices touch;  ///< sources, poses, --json and --picture; the rest is as `touch` has it
  std::string output;
};

void add_align_options(CLI::App& command, AlignOptions& options);

/// `palpate align`; `command` is what was parsed into `options`. @throws UsageError, Error.
void align_sources(const CLI::App& command, const AlignOptions& options);

/// Draws sources before and after they were aligned, into `picture` (`path` in messages).
/// @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
void draw_alignment(const LoadedScene& loaded, const std::vector<AlignedSource>& aligned,
                    const std::string& path, OutputFile& picture);

}  // namespace palpate::app
