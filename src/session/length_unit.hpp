// The length unit of a file: what it states, what is likely, and the setting by which a person
// chooses another.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "palpate/geometry/shapes.hpp"
#include "palpate/io/files.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::session {

/// The tight box of all points, m.
[[nodiscard]] Box bounds_of(const PointCloud& cloud);

/// The box of all points but the outermost thousandth at either end of each axis where those make
/// the box more than twice as long, m: a few outliers do not show what a cloud is.
[[nodiscard]] Box core_of(const PointCloud& cloud);

/// Probable units of a file, and why.
struct UnitsGuess {
  std::string units;
  std::string reason;
  std::string advice;  ///< empty: nothing to do
  double metres = 0;   ///< a unit, where it is so likely that a person is asked; 0: it is not
};

/// Guesses from coordinates as read, in what is taken for metres.
[[nodiscard]] UnitsGuess guess_units(const Box& bounds, const std::string& format);

/// The unit that was used for coordinates whose core_of() is `core`, and what is to be said of it.
[[nodiscard]] UnitsGuess units_of(const FileUnit& unit, const std::string& format, const Box& core);

/// The same of a cloud. Splats have no unit unless one is given.
[[nodiscard]] UnitsGuess units_of(const CloudFile& file, const Box& core);

/// What a person is asked of a file.
struct UnitQuestion {
  Box core;           ///< of what was read, m, in the unit that is taken
  double likely = 0;  ///< metres of the unit that it probably has
};

/// The setting by which a person chooses the unit of a source of that name; it is of `metres` now.
[[nodiscard]] ViewerControls::Setting unit_setting(const std::string& name, double metres,
                                                   const std::optional<UnitQuestion>& question);

/// The source whose unit a setting of that key chooses; unset: it is another setting.
[[nodiscard]] std::optional<std::string> source_of_unit(std::string_view key);

/// Metres of a unit that unit_setting() offers by that name; unset: it is none of them.
[[nodiscard]] std::optional<double> metres_of_unit(std::string_view name);

}  // namespace palpate::session
