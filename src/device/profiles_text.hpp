#pragma once

#include <string_view>

namespace palpate::device {

/// profiles.toml, as it was when this was built.
[[nodiscard]] std::string_view profiles_text();

}  // namespace palpate::device
