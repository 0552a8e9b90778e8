// Prepares a placed cloud at once, all of it together.
#pragma once

#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"

namespace palpate {

/// Takes all steps of prepare() but place(). `report`: what is known so far.
[[nodiscard]] Prepared prepare_at_once(const Placed& placed, const PrepareOptions& options,
                                       Prepared::Report report);

}  // namespace palpate
