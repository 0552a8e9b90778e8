#pragma once

#include <span>
#include <string>
#include <vector>

#include "palpate/geometry/shapes.hpp"
#include "palpate/io/files.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate::app {

/// Probable units of a file, and why.
struct UnitsGuess {
  std::string units;
  std::string reason;
  std::string advice;  ///< empty: nothing to do
  double metres = 0;   ///< a unit, where it is so likely that a person is asked; 0: it is not
};

/// What likely_unit() adds to the format of a file.
inline constexpr const char* kTakenAsMillimetres = ", taken as millimetres";

/// Metres a unit of a file that was read as if it were in metres: 0.001 for STL and OBJ, which
/// state none, where the longest side is 1 to 2000; else 1. Those who draw meshes for printers and
/// machines draw in millimetres: shorter is no part, and longer no machine's.
[[nodiscard]] double likely_unit(const CloudFile& file);

/// Guesses from coordinates as read, in what is taken for metres.
[[nodiscard]] UnitsGuess guess_units(const Box& bounds, const std::string& format);

/// The same of a cloud whose core_of() is `core`. Splats have no unit unless `reading` gives one.
[[nodiscard]] UnitsGuess units_of(const CloudFile& file, const Box& core,
                                  const ReadOptions& reading);

/// Are they all at one position or on a line, where no surface is? So are none.
[[nodiscard]] bool on_a_line(std::span<const Eigen::Vector3f> points);

/// How far points are from one another, m; medians over a sample that is spread over the cloud.
struct SpacingFacts {
  double nearest_three = 0;  ///< mean distance to the three nearest others
  double from_area = 0;      ///< side of the square that a point has to itself
  double tenth = 0;          ///< a tenth of the points have a smaller one from area ...
  double nine_tenths = 0;    ///< ... and a tenth a larger one
};

[[nodiscard]] SpacingFacts measure_spacing(const CellGrid& grid);

/// Share of points, 0-1, at a rim: a border of the cloud or of a hole in it. A point is at a rim if
/// the mean of its neighbours within R lies more than R / 4 away from it: 0 inside an even surface,
/// 0.42 R at a straight border.
[[nodiscard]] double rim_share(const SurfacePoints& points);

/// The tight box of all points, m.
[[nodiscard]] Box bounds_of(const PointCloud& cloud);

/// The box of all points but the outermost thousandth at either end of each axis where those make
/// the box more than twice as long, m: a few outliers do not show what a cloud is.
[[nodiscard]] Box core_of(const PointCloud& cloud);

}  // namespace palpate::app
