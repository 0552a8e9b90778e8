#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "viewer/local_surface.hpp"

namespace palpate::viewer {

/// Message 3 of docs/viewer_protocol.md: `mesh` around `center` (m, relative to the origin). At
/// most 65535 vertices.
[[nodiscard]] std::string encode_surface(std::uint8_t device, const Eigen::Vector3f& center,
                                         const Mesh& mesh);

}  // namespace palpate::viewer
