#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "palpate/tool/tool.hpp"

namespace palpate::session {

/// A tool as JSON: its axis and its samples, each with position, radius (m) and side. They make the
/// same tool again, bit for bit.
[[nodiscard]] nlohmann::ordered_json tool_json(const Tool& tool);

/// What tool_json() wrote; null: no tool.
/// @throws Error when they are no tool's, nlohmann::json::exception when it is something else.
[[nodiscard]] std::shared_ptr<const Tool> tool_in(const nlohmann::ordered_json& json);

}  // namespace palpate::session
