#pragma once

#include <string_view>

namespace palpate::app {

/// picture.py, as CMake found it.
[[nodiscard]] std::string_view picture_script();

/// figures.py likewise.
[[nodiscard]] std::string_view figures_script();

/// The project's version.
[[nodiscard]] std::string_view version();

}  // namespace palpate::app
