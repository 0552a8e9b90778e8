#pragma once

#include <pybind11/pybind11.h>

namespace palpate::python {

/// Each puts one concept into the module.
void define_clouds(pybind11::module_& module);
void define_files(pybind11::module_& module);
void define_scene(pybind11::module_& module);
void define_cameras(pybind11::module_& module);
void define_fields(pybind11::module_& module);
void define_proxy(pybind11::module_& module);
void define_tools(pybind11::module_& module);
void define_servo(pybind11::module_& module);

}  // namespace palpate::python
