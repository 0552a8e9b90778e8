#pragma once

#include "any_cloud/draft.hpp"

namespace palpate::any_cloud {

/// One hand that pokes a closed body around the origin 25 times: from a ball around it
/// straight to a point of its surface, in by 2 to 3 spacings where the body is that thick, out the
/// same way, and on through free air. It is never put anywhere, so a proxy that is caught inside
/// stays so.
void poke_around(Draft& draft);

/// One hand that moves straight to drawn places for draft.roam ticks, around a closed body and in
/// it. Where it is 3 spacings deep it turns back.
void roam_around(Draft& draft);

}  // namespace palpate::any_cloud
