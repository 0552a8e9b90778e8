#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "scene.hpp"

namespace palpate::python {

/// Reads an image of 16-bit or 32-bit numbers into memory of the camera's last one.
void take_image(const pybind11::array& image, Camera& camera);

/// Says why the camera's image can be no surface, and what to give: it measured something, and
/// nothing in range. Empty: it may be one. `whole`: it came as whole numbers.
[[nodiscard]] std::string problem_of(const Camera& camera, bool whole);

}  // namespace palpate::python
