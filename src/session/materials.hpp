// Materials that presets give to a surface.
#pragma once

#include <array>
#include <string_view>

#include "palpate/contact/proxy.hpp"

namespace palpate::session {

/// What a surface is made of, beside a run's initial one.
struct Material {
  std::string_view name;
  double stiffness;      ///< times the initial one
  double friction;       ///< coefficient, static and dynamic
  Texture texture = {};  ///< m of the hand
};

// Textures are as deep as stays smooth under 1 N where a run begins with 500 N/m: wavelength^2 /
// (40 depth of the hand). Deeper ones would make the hand jump from grain to grain.
inline constexpr std::array<Material, 4> kMaterials = {{
    // 0.3: 1 N goes 7 mm deep, the thickness of a pelt. 0.5: hairs hold a stroke back. 3 mm: tufts.
    {"fur", 0.3, 0.5, {.amplitude = 3e-5, .wavelength = 3e-3}},
    // 1.2: yields by 1.7 mm at 1 N, which leaves room for a relief, and is below ice where a
    // device bears 800 N/m, too. 0.35: dry wood on wood has 0.25 to 0.5. 2 mm: 25 to 100 grains a
    // second at 5 to 20 cm/s, which fingers feel well.
    {"wood", 1.2, 0.35, {.amplitude = 6e-5, .wavelength = 2e-3}},
    // 2.4: 1200 N/m, below the 2000 that a simulated hand holds without humming. 0.02: steel on
    // ice.
    {"ice", 2.4, 0.02},
    // 0.4: 1 N goes 5 mm deep, as into an eraser. 1: dry rubber; a cone of 45 degrees.
    {"rubber", 0.4, 1},
}};

}  // namespace palpate::session
