// Declares clouds made from formulas, for trials without a file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

struct SyntheticOptions {
  double spacing = 2e-3;   ///< mean distance between points, m; > 0
  double noise = 0;        ///< standard deviation along the normal, m
  std::uint64_t seed = 1;  ///< of jitter and noise; same seed, same cloud, on every machine
};

/// A cloud that a formula makes, and what it shows.
struct SyntheticName {
  std::string_view name;
  std::string_view description;
};

/// The clouds that synthetic_cloud() can make.
[[nodiscard]] std::span<const SyntheticName> synthetic_names();

/// Makes a cloud of some decimetres, in metres, with normals; those seen from one side have a
/// viewpoint. Points are jittered by a fifth of the spacing, as no scanner's are regular.
/// @throws Error that lists the names when `name` is none of them, or on options out of range.
[[nodiscard]] PointCloud synthetic_cloud(std::string_view name,
                                         const SyntheticOptions& options = {});

}  // namespace palpate
