#pragma once

#include <string>
#include <vector>

#include "palpate/servo/servo.hpp"

namespace palpate::viewer {

/// What each servo's tool is called: its device's name, with a number where several have that name:
/// "simulated 1", "simulated 2".
[[nodiscard]] std::vector<std::string> tool_names(const std::vector<Servo*>& servos);

}  // namespace palpate::viewer
