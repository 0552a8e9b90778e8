#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>

#include "options.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/io/files.hpp"

namespace palpate::python {

/// The cloud that `given` is: a PointCloud, the path of a file, or an array of points with what
/// `keywords` have beside them (normals, colors, intensities).
/// @throws py::type_error for arrays that would have to be cast; Error as reading does.
[[nodiscard]] std::shared_ptr<const PointCloud> cloud_of(const py::object& given,
                                                         Keywords& keywords);

/// Reads a file. Python is warned where its unit was guessed. Without the interpreter's lock;
/// hears signals.
/// @throws Error as read_cloud_file() does.
[[nodiscard]] PointCloud read_with_warning(const std::filesystem::path& path, ReadOptions options);

/// Shares the points with Python, read-only.
[[nodiscard]] py::object shared(const std::shared_ptr<const SurfacePoints>& points);

}  // namespace palpate::python
