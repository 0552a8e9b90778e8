// Binds the reading, writing and making of cloud files.
#include "palpate/io/files.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <optional>
#include <variant>

#include "arrays.hpp"
#include "clouds.hpp"
#include "gil.hpp"
#include "module.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate::python {
namespace {

constexpr const char* kRead =
    R"(Reads clouds (PLY, PCD, XYZ, LAS, LAZ, E57), meshes (OBJ, PLY, STL, glTF, GLB), Gaussian splats or a depth image, also gzipped.

The scans of an E57 file are joined; "a.e57#2" is the second one.

scale: metres for one of the file's units, or two numbers where heights have another; None: what the file states, else what touch takes (a warning says so). Or length: m, of the cloud's longest side. mesh_spacing: m between the points that faces are sampled into; 0: chosen. Of a depth image: K = (fx, fy, cx, cy), pixels; unit: metres a step.)";

constexpr const char* kWrite = R"(Writes PLY or PCD, by the path's ending.

cloud: a PointCloud or an (n, 3) array with the keywords of PointCloud. ascii: text instead of binary.)";

constexpr const char* kSynthetic =
    R"(A cloud that a formula makes: bumps, sheet, sphere, torus, table, rabbit, room.

spacing: m between points; noise: its standard deviation along the normal, m.)";

PointCloud read_file(const std::filesystem::path& path,
                     const std::optional<std::variant<double, std::array<double, 2>>>& scale,
                     std::optional<double> length, const std::optional<std::array<double, 4>>& K,
                     double unit, double mesh_spacing) {
  ReadOptions options{.length = length, .depth_unit = unit, .mesh_spacing = mesh_spacing};
  if (scale && std::holds_alternative<double>(*scale)) options.scale = std::get<double>(*scale);
  if (scale && !options.scale) {
    const auto& [plan, height] = std::get<std::array<double, 2>>(*scale);
    options.scale = plan;
    options.height_scale = height;
  }
  if (K) options.intrinsics = {(*K)[0], (*K)[1], (*K)[2], (*K)[3]};
  return read_with_warning(path, options);
}

void write_file(const std::filesystem::path& path, const py::object& cloud, bool ascii,
                const py::kwargs& given) {
  Keywords keywords(given, "write_cloud");
  const auto points = cloud_of(cloud, keywords);
  keywords.finish();
  const Away away;
  write_cloud(path, *points, {.ascii = ascii});
}

PointCloud synthetic(const std::string& name, double spacing, double noise, std::uint64_t seed) {
  return synthetic_cloud(name, {.spacing = spacing, .noise = noise, .seed = seed});
}

}  // namespace

void define_files(py::module_& module) {
  using py::arg;
  using Free = py::call_guard<Released>;
  module.def("read_cloud", &read_file, Free(), arg("path"), py::kw_only(),
             arg("scale") = py::none(), arg("length") = py::none(), arg("K") = py::none(),
             arg("unit") = 1e-3, arg("mesh_spacing") = 0.0, kRead);
  module.def("write_cloud", &write_file, arg("path"), arg("cloud"), py::kw_only(),
             arg("ascii") = false, kWrite);
  module.def("synthetic_cloud", &synthetic, Free(), arg("name"), py::kw_only(),
             arg("spacing") = 2e-3, arg("noise") = 0.0, arg("seed") = 1, kSynthetic);
}

}  // namespace palpate::python
