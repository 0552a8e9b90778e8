// Lists what makes points better than the core of prepare() does.
#pragma once

#include <span>

#include "prepare/surfels.hpp"

namespace palpate {

/// All refinements, in the order in which those of one stage run.
[[nodiscard]] std::span<const Refinement> refinements();

}  // namespace palpate
