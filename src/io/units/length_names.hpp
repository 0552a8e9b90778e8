#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate::io {

/// Metres of a unit of length by any of its names, of any case: mm, Metre, US survey foot, yards.
[[nodiscard]] std::optional<double> metres_of(std::string_view name);

/// Can it be a unit of length, 1e-9 to 1e9 m? Nothing smaller or larger is touched.
[[nodiscard]] bool is_unit_of_length(double metres);

/// The name of a unit of so many metres: "millimetres", "feet"; else "units of 0.2012 m".
[[nodiscard]] std::string name_of_length(double metres);

/// Are two units the same to a hundred-thousandth? The US survey foot is 2e-6 longer than a foot.
[[nodiscard]] bool is_same_unit(double metres, double other);

/// Metres of a unit as a sentence about units states it: "Unit: meter", "1 unit = 1000 mm", "file
/// units = feet", "all coordinates in mm". None that no length can have.
[[nodiscard]] std::optional<double> unit_in_sentence(std::string_view text);

/// Metres of a unit in brackets, or behind a blank, an underscore or a slash, at the end of a name:
/// "X [mm]", "Easting (ft)", "z_m".
[[nodiscard]] std::optional<double> unit_behind_name(std::string_view name);

}  // namespace palpate::io
