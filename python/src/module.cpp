// Defines the Python module.
#include "module.hpp"

#include <fmt/format.h>

#include <string>

#include "options.hpp"
#include "palpate/base/error.hpp"

namespace palpate::python {
namespace {

namespace py = pybind11;

// Whoever pickles or copies an object of `type` is told what to do instead.
void refuse_pickling(const py::module_& module, const char* type, const char* remedy) {
  const auto refuse = [remedy](const py::object& self) -> py::object {
    const auto name = py::type::of(self).attr("__name__").cast<std::string>();
    throw py::type_error(fmt::format("a {} cannot be pickled; {}", name, remedy));
  };
  const py::object its = module.attr(type);
  its.attr("__reduce__") = py::cpp_function(refuse, py::name("__reduce__"), py::is_method(its));
}

void refuse_pickling(const py::module_& module) {
  const char* const remake = "make it again in each process, of arrays or files";
  for (const char* type :
       {"AnyField", "Proxy", "Scene", "Source", "Servo", "DepthCamera", "ToolProxy", "Tool"}) {
    refuse_pickling(module, type, remake);
  }
  refuse_pickling(module, "PointCloud",
                  "pickle its arrays (points, normals, ...) or write_cloud()");
  refuse_pickling(module, "SurfacePoints", "pickle its arrays, or prepare() the cloud again");
  refuse_pickling(module, "Prepared", "pickle the arrays of its points, or prepare() again");
  refuse_pickling(module, "Rollout", "pickle its columns()");
  for (const char* type : {"Contact", "ToolContact", "PrepareReport", "SourceState", "Frame"}) {
    refuse_pickling(module, type, "pickle the properties that you need");
  }
}

}  // namespace
}  // namespace palpate::python

PYBIND11_MODULE(_palpate, module) {
  namespace python = palpate::python;
  pybind11::options options;
  options.disable_function_signatures();  // palpate/__init__.pyi has them, with types
  pybind11::register_exception<palpate::Error>(module, "Error", PyExc_ValueError);
  python::define_clouds(module);
  python::define_files(module);
  python::define_scene(module);
  python::define_cameras(module);
  python::define_fields(module);
  python::define_proxy(module);
  python::define_tools(module);
  python::define_servo(module);
  python::define_keywords(module);
  python::refuse_pickling(module);
}
