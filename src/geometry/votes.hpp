#pragma once

#include <vector>

#include "geometry/patches.hpp"
#include "geometry/signed_forest.hpp"

namespace palpate::detail {

/// What neighbours in different patches say about the patches' relative signs, in the points'
/// order. The same two patches may come more than once.
[[nodiscard]] std::vector<Vote> collect_votes(const PatchInput& input, const Patches& patches);

}  // namespace palpate::detail
