#pragma once

#include "any_cloud/draft.hpp"

namespace palpate::any_cloud {

/// A closed body around the origin, and how far it reaches.
struct Body {
  Shape shape;
  Eigen::Vector3d reach;
};

/// A capsule, box, torus, dumbbell, relief or cup: chance decides.
[[nodiscard]] Body draw_body(Draft& draft);

}  // namespace palpate::any_cloud
