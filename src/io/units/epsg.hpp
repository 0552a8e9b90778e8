#pragma once

#include <optional>

namespace palpate::io {

/// Metres of the unit of length with that code in the EPSG's register; nothing for another code.
[[nodiscard]] std::optional<double> metres_of_epsg_unit(unsigned code);

/// Metres a unit of the axes of a projected or vertical system with that code in the EPSG's
/// register: the foot for all that have a kind of foot, to a hundred-thousandth, and the metre for
/// all that are not known to have another unit. Nothing: the code is a user's own, or of degrees.
[[nodiscard]] std::optional<double> metres_of_epsg_system(unsigned code);

/// Is it the code of a geographic system, whose x and y are longitude and latitude?
[[nodiscard]] bool is_epsg_system_in_degrees(unsigned code);

}  // namespace palpate::io
