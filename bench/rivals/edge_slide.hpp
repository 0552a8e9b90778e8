#pragma once

#include <string>

#include "rivals/compare.hpp"

namespace palpate::rivals {

/// The forces of all methods, and the ideal one, on the way up to the first layout's box edge and
/// off it, with noise a: lines of method, seconds, force along the top's normal and across it, N.
[[nodiscard]] std::string edge_slide_csv(CompareOptions options);

}  // namespace palpate::rivals
