#pragma once

#include <nlohmann/json.hpp>

namespace palpate::app {

/// Reports keep their keys in the order in which they are written.
using Json = nlohmann::ordered_json;

}  // namespace palpate::app
