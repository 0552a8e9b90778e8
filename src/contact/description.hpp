#pragma once

#include "base/description.hpp"
#include "palpate/contact/proxy.hpp"

/// The descriptions of the options of proxies.
namespace palpate {

// In the order in which help and errors list them.
inline constexpr std::array<Named<ProxyOptions::Method>, 2> kMethods = {
    {{"converged", ProxyOptions::Method::converged},
     {"single_step", ProxyOptions::Method::single_step}}};
[[nodiscard]] constexpr const auto& choices(ProxyOptions::Method /*of*/) {
  return kMethods;
}

template <EitherConst<Friction> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [resting, dynamic, viscous] = options;
  take(About{"static", "", kNotNegative,
             "friction coefficient while the proxy sticks (default: --friction-dynamic)",
             everywhere, "MU"},
       resting);
  take(About{"dynamic", "", kNotNegative, "friction coefficient while the proxy slides (0)",
             everywhere, "MU"},
       dynamic);
  take(About{"viscous", "N s/m", kNotNegative,
             "viscous friction, proportional to the sliding speed (0)"},
       viscous);
}

template <EitherConst<Texture> Options>
void describe(Options& options, const auto& take) {
  auto& [amplitude, wavelength] = options;
  take(
      About{"amplitude", "m", kNotNegative, "amplitude of a fine texture on the surface (0: none)"},
      amplitude);
  take(About{"wavelength", "m", kPositive, "wavelength of that texture (0.004)"}, wavelength);
}

template <EitherConst<ProxyOptions> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [stiffness, friction, texture, method, iterations, tolerance, rise] = options;
  take(About{"stiffness", "N/m", kNotNegative,
             "stiffness K of the surface, in the cloud's metres (500; less if a large cloud is "
             "explored)"},
       stiffness);
  take(About{"friction"}, friction);
  take(About{"texture"}, texture);
  take(About{"method", "", {}, "", python}, method);
  // 1000 is fifty times the default; more is a mistake (judgement).
  take(About{"max_iterations", "", {.least = 1, .most = 1000}, "", python}, iterations);
  take(About{"tangent_tolerance",
             "",
             {.least = 1e-6, .most = 0.1, .words = "1e-6 to 0.1 support radii"},
             "",
             python},
       tolerance);
  take(About{"rise_time", "s", positive_or("no rise that nothing pays for"), "", python}, rise);
}

}  // namespace palpate
