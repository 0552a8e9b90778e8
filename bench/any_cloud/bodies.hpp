#pragma once

#include "any_cloud/draft.hpp"

namespace palpate::any_cloud {

/// A closed body around the origin, and how far it reaches.
struct Body {
  Shape shape;
  Eigen::Vector3d reach;
};

/// Makes it the truth, and puts points all over it.
void scan(Draft& draft, const Body& body);

/// A capsule, box, torus, dumbbell, relief or cup: chance decides.
[[nodiscard]] Body draw_body(Draft& draft);

}  // namespace palpate::any_cloud
