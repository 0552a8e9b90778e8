#pragma once

#include <span>
#include <vector>

#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

/// The set-up file's sources and then those of the command line; one of these that has the name of
/// one of the file's takes its place and keeps its pose and options. --pose wins over the file.
/// What depends on the whole surface is filled in.
/// @throws UsageError when there is none, two have one name, a pose names none of them, or options
/// of one contradict each other.
[[nodiscard]] std::vector<DescribedSource> choose_sources(const TouchChoices& choices,
                                                          const SurfacePlan& surface);

/// Tells in `facts` of one more source.
void add_facts(RunFacts& facts, const SourcePlan& source);

/// What becomes of a source's frames or clouds in time.
[[nodiscard]] Policy policy_of(const SourcePlan& source);

/// Is --history a policy's?
[[nodiscard]] bool keeps_history(Policy policy);

}  // namespace palpate::app
