#pragma once

#include <string>
#include <vector>

#include "accuracy/recorded.hpp"
#include "common/main.hpp"
#include "rivals/rival.hpp"

/// Methods in what other benches play, under their scores.
namespace palpate::rivals {

/// Table B's experiments with one camera as Markdown; palpate's default and the paper's way with
/// one and with four clouds stand beside the methods.
[[nodiscard]] std::string markdown_streams(const bench::SeedOptions& options,
                                           const std::vector<Method>& methods);

/// Prints a table for each of the rows of events_bench, medians over the seeds with the worst in
/// brackets, palpate's default first.
void print_events(const bench::SeedOptions& options, const std::vector<Method>& methods);

/// Prints such tables for the rows of any_cloud_bench; methods that need an image have no line.
void print_clouds(const bench::SeedOptions& options, const std::vector<Method>& methods);

/// The table of `accuracy_bench --recording`. @throws Error as recorded_report() does.
[[nodiscard]] std::string markdown_recording(const accuracy::RecordedOptions& options,
                                             const std::vector<Method>& methods);

}  // namespace palpate::rivals
