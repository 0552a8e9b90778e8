#pragma once

#include <optional>
#include <string_view>

namespace palpate::io {

/// What a description of coordinates states of their units.
struct StatedUnits {
  std::optional<double> plan{};    ///< m a unit of x and y
  std::optional<double> height{};  ///< m a unit of z
  double assumed = 1;              ///< of x and y where only that of z is stated
  bool degrees = false;            ///< x and y are longitude and latitude
};

/// What a system of coordinates states: well-known text, text of PROJ ("+proj=utm +units=us-ft"),
/// or a code ("EPSG:2225"). Systems may be compound, bound, or with heights of their own.
[[nodiscard]] StatedUnits units_in_projection(std::string_view text);

}  // namespace palpate::io
