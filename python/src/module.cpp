// Defines the Python module.
#include "module.hpp"

#include "palpate/base/error.hpp"

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
  python::define_servo(module);
}
