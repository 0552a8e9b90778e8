#pragma once

#include <string>
#include <string_view>

namespace palpate::app {

/// The project's version.
[[nodiscard]] std::string_view version();

/// Lines on how the program was built: revision, compiler, libraries, where its documents lie.
[[nodiscard]] std::string build_details();

}  // namespace palpate::app
