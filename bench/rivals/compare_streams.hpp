#pragma once

#include <string>
#include <vector>

#include "rivals/rival.hpp"
#include "streams/stream_experiments.hpp"

namespace palpate::rivals {

/// Table B's experiments with one camera as Markdown: palpate's default, the paper's way with one
/// and with four clouds, and those of the methods that are not palpate's.
[[nodiscard]] std::string markdown_streams(const streams::Options& options,
                                           const std::vector<Method>& methods);

}  // namespace palpate::rivals
