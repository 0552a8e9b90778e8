#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace palpate::viewer {

/// A unit normal in two bytes (docs/viewer_protocol.md); what has no direction becomes +z.
[[nodiscard]] std::array<std::int8_t, 2> octahedral(const Eigen::Vector3f& normal) noexcept;

}  // namespace palpate::viewer
