#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace palpate::app {

/// Reports keep their keys in the order in which they are written.
using Json = nlohmann::ordered_json;

/// Indented, with a line's end. Bytes that are not UTF-8, as names of files may have, become
/// U+FFFD.
[[nodiscard]] inline std::string text_of(const Json& data) {
  return data.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::app
