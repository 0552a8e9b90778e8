#pragma once

#include <string_view>

namespace palpate::app {

/// drawing.py, which the others import, as CMake found it.
[[nodiscard]] std::string_view drawing_script();

/// picture.py likewise.
[[nodiscard]] std::string_view picture_script();

/// figures.py likewise.
[[nodiscard]] std::string_view figures_script();

/// trust.py likewise.
[[nodiscard]] std::string_view trust_script();

/// align.py likewise.
[[nodiscard]] std::string_view align_script();

/// The project's version.
[[nodiscard]] std::string_view version();

}  // namespace palpate::app
