#pragma once

#include "accuracy/contender.hpp"
#include "rivals/rival.hpp"

namespace palpate::rivals {

/// A contender of table A, which is a Scene, a SceneField and a Proxy, as a method among others.
/// One that takes depth frames takes the points where there is no frame.
[[nodiscard]] std::unique_ptr<Rival> make_rival(const accuracy::Contender& contender);

}  // namespace palpate::rivals
