// Knows the lists that COLMAP writes as text.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "io/input.hpp"

namespace palpate::io::colmap {

/// What stands above the points, where somebody left that out.
inline constexpr std::string_view kPoints = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]";

/// Refuses a comment that begins one of the lists beside the points.
inline void refuse_others(const Input& input, std::string_view comment) {
  for (const auto& [names, what] :
       {std::pair("CAMERA_ID, MODEL", "cameras"), std::pair("IMAGE_ID, QW, QX", "pictures")}) {
    if (comment.find(names) == std::string_view::npos) continue;
    fail(input, fmt::format("this is COLMAP's list of {}, not of points", what),
         "Give points3D.txt, which lies beside it");
  }
}

}  // namespace palpate::io::colmap
