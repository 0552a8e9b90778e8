#pragma once

#include "palpate/geometry/ball.hpp"

namespace palpate {

/// Where a tool can be before the next frames: around hand and proxy. World frame. Fields publish
/// it, preparation clips to it and runs the costly fit in it.
using Reach = Ball;

}  // namespace palpate
