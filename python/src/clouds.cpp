// Binds point clouds and their preparation.
#include "clouds.hpp"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "io/cloud_builder.hpp"
#include "io/units/file_unit.hpp"
#include "module.hpp"
#include "palpate/io/files.hpp"

namespace palpate::python {
namespace {

using Report = Prepared::Report;

void take_points(const Vectors& points, PointCloud& cloud) {
  const Away away;
  if (points.is_float32()) {
    cloud.positions.assign(points.floats().begin(), points.floats().end());
    return;
  }
  cloud.origin = io::choose_origin(points.size(), [&](std::size_t i) { return points[i]; });
  cloud.positions.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.positions[i] = (points[i] - cloud.origin).cast<float>();
  }
}

void take_normals(const py::object& given, PointCloud& cloud) {
  const Vectors normals(given, "normals");
  for (std::size_t i = 0; i < normals.size(); ++i) {
    cloud.normals.push_back(io::unit_normal(normals[i]));
  }
}

std::shared_ptr<PointCloud> cloud_of_arrays(const py::object& points, Keywords& keywords) {
  auto cloud = std::make_shared<PointCloud>();
  py::object column = py::none();
  take_points(Vectors(points, "points"), *cloud);
  if (keywords.take("normals", column) && !column.is_none()) take_normals(column, *cloud);
  if (keywords.take("colors", column) && !column.is_none()) {
    const py::array colors = readable(column, "colors", {kUint8}, {-1, 3});
    const auto* const first = static_cast<const std::array<std::uint8_t, 3>*>(colors.data());
    cloud->colors.assign(first, first + colors.shape(0));
  }
  if (keywords.take("intensities", column) && !column.is_none()) {
    const py::array values = readable(column, "intensities", {kFloat32}, {-1});
    const auto* const first = static_cast<const float*>(values.data());
    cloud->intensities.assign(first, first + values.shape(0));
  }
  return cloud;
}

std::shared_ptr<PointCloud> new_cloud(const py::object& points, const py::kwargs& given) {
  Keywords keywords(given, "PointCloud");
  auto cloud = cloud_of_arrays(points, keywords);
  keywords.take("viewpoint", cloud->viewpoint);
  keywords.finish();
  return cloud;
}

std::shared_ptr<Prepared> prepare_cloud(const py::object& cloud, const Eigen::MatrixXd& pose,
                                        const py::kwargs& given) {
  Keywords keywords(given, "prepare");
  PrepareOptions options;
  const auto points = cloud_of(cloud, keywords);
  take(keywords, options);
  keywords.finish();
  const Eigen::Isometry3d T_world_sensor = pose_of(pose);
  const Away away;
  return std::make_shared<Prepared>(palpate::prepare(*points, options, T_world_sensor));
}

std::string words(const PointCloud& cloud) {
  const auto with = [](bool there, const char* what) { return std::string(there ? what : ""); };
  return fmt::format("PointCloud of {} points{}{}{}", cloud.size(),
                     with(!cloud.normals.empty(), ", with normals"),
                     with(!cloud.colors.empty(), ", with colours"),
                     with(!cloud.intensities.empty(), ", with intensities"));
}

std::string words(const Report& report) {
  return fmt::format(
      "{} points of {} are felt; spacing {:.4g} m, noise {:.2g} m, R {:.4g} m; {:.1f} % untrusted",
      report.points_out, report.points_in, report.spacing, report.noise, report.radius,
      100 * report.untrusted);
}

/// Columns of `T`, as arrays that cannot be written to and keep it alive; each is relative to
/// `origin`.
template <class T, class Column>
auto vectors(Column column) {
  return [column](const py::object& self) {
    return view_of(std::span<const Eigen::Vector3f>(column(self.cast<const T&>())), self);
  };
}

template <class T>
auto colors_of() {
  return [](const py::object& self) {
    const auto& colors = self.cast<const T&>().colors;
    const std::uint8_t* const data = colors.empty() ? nullptr : colors.front().data();
    return view_of(data, {static_cast<py::ssize_t>(colors.size()), 3}, self);
  };
}

template <class T>
auto numbers(std::vector<float> T::*column) {
  return [column](const py::object& self) {
    const std::vector<float>& values = self.cast<const T&>().*column;
    return view_of(values.data(), {static_cast<py::ssize_t>(values.size())}, self);
  };
}

/// (n, 3) float64 in the frame of `origin`.
py::array_t<double> absolute(std::span<const Eigen::Vector3f> positions,
                             const Eigen::Vector3d& origin) {
  py::array_t<double> result({static_cast<py::ssize_t>(positions.size()), py::ssize_t{3}});
  double* out = result.mutable_data();
  const Away away;
  for (const Eigen::Vector3f& p : positions) {
    Eigen::Map<Eigen::Vector3d>(std::exchange(out, out + 3)) = origin + p.cast<double>();
  }
  return result;
}

constexpr const char* kCloud = R"(Points of one file or sensor, m, in its own frame.

Made of an (n, 3) array and keywords: normals (n, 3), colors (n, 3) uint8, intensities (n,), viewpoint (3,). What is given is copied once. Arrays are views that cannot be written to.)";

constexpr const char* kPoints =
    R"(Indexed points with all that a field needs, world frame, in the index's order.

Arrays are views that cannot be written to.)";

constexpr const char* kPrepare =
    R"(Filters and indexes a cloud and finds its smooth segments, on every core.

cloud: a PointCloud, a file, or an (n, 3) array with the keywords of PointCloud. pose: (4, 4), cloud to world.
Keywords: {}.)";

void define_cloud(py::module_& module) {
  using Cloud = PointCloud;
  py::class_<Cloud, std::shared_ptr<Cloud>>(module, "PointCloud", kCloud)
      .def(py::init(&new_cloud))
      .def("__len__", &Cloud::size)
      .def("__repr__", [](const Cloud& cloud) { return words(cloud); })
      .def_property_readonly(
          "points", [](const Cloud& cloud) { return absolute(cloud.positions, cloud.origin); },
          "(n, 3) float64, m: a new array of origin + positions")
      .def_readonly("origin", &Cloud::origin, "(3,) m: positions are relative to it")
      .def_property_readonly("positions",
                             vectors<Cloud>([](auto& c) { return std::span(c.positions); }),
                             "(n, 3) float32, m, relative to origin; a view")
      .def_property_readonly("normals",
                             vectors<Cloud>([](auto& c) { return std::span(c.normals); }),
                             "(n, 3) float32, unit or zero; (0, 3) where there are none")
      .def_property_readonly("colors", colors_of<Cloud>(),
                             "(n, 3) uint8: red, green, blue; (0, 3): none")
      .def_property_readonly("intensities", numbers(&Cloud::intensities),
                             "(n,) float32; (0,): none")
      .def_readonly("viewpoint", &Cloud::viewpoint,
                    "(3,) m: where the sensor was; None: not known");
}

void define_surface_points(py::module_& module) {
  using Points = SurfacePoints;
  py::class_<Points, std::shared_ptr<Points>>(module, "SurfacePoints", kPoints)
      .def("__len__", &Points::size)
      .def("__repr__",
           [](const Points& points) {
             return fmt::format("SurfacePoints: {} points, R {:.4g} m", points.size(),
                                points.radius);
           })
      .def_property_readonly(
          "points",
          [](const Points& points) { return absolute(points.grid.points(), points.origin); },
          "(n, 3) float64, m: a new array of origin + positions")
      .def_readonly("origin", &Points::origin, "(3,) m: positions are relative to it")
      .def_property_readonly("positions", vectors<Points>([](auto& p) { return p.grid.points(); }),
                             "(n, 3) float32, m, relative to origin")
      .def_property_readonly("normals",
                             vectors<Points>([](auto& p) { return std::span(p.normals); }),
                             "(n, 3) float32, unit or zero; (0, 3): none")
      .def_property_readonly("colors", colors_of<Points>(), "(n, 3) uint8; (0, 3): none")
      .def_property_readonly("radii", numbers(&Points::radii), "(n,) float32, m: support radii R")
      .def_property_readonly("confidences", numbers(&Points::confidences),
                             "(n,) float32, 0-1: trust in the normals")
      .def_readonly("radius", &Points::radius, "typical R, m");
}

void define_report(py::module_& module) {
  py::class_<Report>(module, "PrepareReport", "What preparation found")
      .def("__repr__", [](const Report& report) { return words(report); })
      .def_readonly("points_in", &Report::points_in)
      .def_readonly("points_out", &Report::points_out, "points that are felt")
      .def_readonly("duplicates", &Report::duplicates)
      .def_readonly("speckle", &Report::speckle)
      .def_readonly("spacing", &Report::spacing, "median, m")
      .def_readonly("noise", &Report::noise, "rms distance from a smooth surface, m")
      .def_readonly("voxel", &Report::voxel, "leaf of the voxel filter, m; 0: none")
      .def_readonly("radius", &Report::radius, "R, median, m")
      .def_readonly("trust_low", &Report::trust_low, "a tenth of the points are trusted less, 0-1")
      .def_readonly("untrusted", &Report::untrusted, "share of points felt as metaball, 0-1");
  py::class_<Prepared, std::shared_ptr<Prepared>>(module, "Prepared",
                                                  "A cloud as a surface, and a report")
      .def("__repr__", [](const Prepared& prepared) { return words(prepared.report); })
      .def_readonly("report", &Prepared::report)
      .def_property_readonly("points", [](const std::shared_ptr<Prepared>& prepared) {
        return shared({prepared, &prepared->points});
      });
}

}  // namespace

std::shared_ptr<const PointCloud> cloud_of(const py::object& given, Keywords& keywords) {
  if (py::isinstance<PointCloud>(given)) return given.cast<std::shared_ptr<PointCloud>>();
  const bool is_path = py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__");
  if (!is_path) return cloud_of_arrays(given, keywords);
  const auto path = given.cast<std::filesystem::path>();
  const Away away;
  return std::make_shared<PointCloud>(read_with_warning(path, {}));
}

// What a user should know of the unit that was taken; nothing where the file states it.
std::string remark_on(const FileUnit& unit) {
  if (unit.source == FileUnit::Source::likely) {
    return fmt::format("taken as {}: {}; give scale={} if that is wrong",
                       unit.plan == 1 ? "metres" : "millimetres", unit.words,
                       unit.plan == 1 ? "0.001" : "1");
  }
  if (unit.source != FileUnit::Source::stated) return {};
  if (io::states_heights_alone(unit)) {
    return fmt::format(
        "the file says by {} that heights are in units of {:.12g} m, and nothing of x and y, which "
        "are taken to be in units of {:.12g} m; give scale=({:.12g}, {:.12g}) if they are in "
        "others",
        unit.words, unit.height, unit.plan, io::other_plan(unit), unit.height);
  }
  if (unit.height_stated || unit.plan == 1) return {};
  return fmt::format(
      "the file says by {} that x and y are in units of {:.12g} m, and nothing of heights, which "
      "are taken to be, too; give scale=({:.12g}, 1) if they are in metres",
      unit.words, unit.plan, unit.plan);
}

PointCloud read_with_warning(const std::filesystem::path& path, ReadOptions options) {
  options.progress = hearing();
  CloudFile file = read_cloud_file(path, options);
  const std::string remark = remark_on(file.unit);
  if (remark.empty()) return std::move(file.cloud);
  const std::string text = path.string() + ": " + remark;
  const py::gil_scoped_acquire held;
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
  return std::move(file.cloud);
}

py::object shared(const std::shared_ptr<const SurfacePoints>& points) {
  return py::cast(std::const_pointer_cast<SurfacePoints>(points));
}

void define_clouds(py::module_& module) {
  define_cloud(module);
  define_surface_points(module);
  define_report(module);
  module.def("prepare", &prepare_cloud, py::arg("cloud"),
             py::arg("pose") = Eigen::Matrix4d::Identity().eval(),
             fmt::format(kPrepare, listed(keywords_of<PrepareOptions>())).c_str());
}

}  // namespace palpate::python
