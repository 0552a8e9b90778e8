#pragma once

#include "base/description.hpp"
#include "palpate/field/field_options.hpp"

/// The descriptions of the options of fields.
namespace palpate {

// In the order in which help and errors list them.
inline constexpr std::array<Named<FieldOptions::Kind>, 3> kFields = {
    {{"balanced", FieldOptions::Kind::balanced},
     {"pointset", FieldOptions::Kind::pointset},
     {"metaball", FieldOptions::Kind::metaball}}};
[[nodiscard]] constexpr const auto& choices(FieldOptions::Kind /*of*/) {
  return kFields;
}

// In the order in which help and errors list them.
inline constexpr std::array<Named<Kernel>, 2> kKernels = {
    {{"wyvill", Kernel::wyvill}, {"wendland", Kernel::wendland}}};
[[nodiscard]] constexpr const auto& choices(Kernel /*of*/) {
  return kKernels;
}

// In the order in which help and errors list them.
inline constexpr std::array<Named<FieldOptions::Gradient>, 3> kGradients = {
    {{"exact", FieldOptions::Gradient::exact},
     {"normal", FieldOptions::Gradient::normal},
     {"printed", FieldOptions::Gradient::printed}}};
[[nodiscard]] constexpr const auto& choices(FieldOptions::Gradient /*of*/) {
  return kGradients;
}

template <EitherConst<FieldOptions> Options>
void describe(Options& options, const auto& take) {
  using enum Offered;
  auto& [kind, kernel, gradient, threshold, support, tool, capped, sharp, raw, nearest] = options;
  take(About{"kind",
             "",
             {},
             "implicit function of the surface: balanced (default), pointset or metaball"},
       kind);
  take(About{"kernel", "", {}, "wyvill (default) or wendland"}, kernel);
  take(About{"gradient",
             "",
             {},
             "gradient of the field: exact (default), or as in the paper: normal (eq. 8, "
             "point-set) or printed (eq. 4 of the metaball as printed, which points inward)"},
       gradient);
  take(About{"threshold", "", kPositive,
             "iso-level of the metaball, 0 to 1; lower moves the surface outward (0.4). Other "
             "fields become a metaball where normals are unreliable",
             everywhere, "LEVEL"},
       threshold);
  take(About{"minimum_support",
             "",
             {.least = 0, .most = 1, .open = true, .words = "a number between 0 and 1"},
             "",
             python},
       support);
  take(About{"tool_radius", "m", kNotNegative, "radius of the spherical tool; 0: a point"}, tool);
  take(About{"capped", "", {}, "", python}, capped);
  take(About{"sharp_edges", "", {}, "false: edges and creases of depth images are rounded", files},
       sharp);
  take(About{"raw_weights", "", {}, "", recordings}, raw);
  take(About{"nearest_radius", "", {}, "", recordings}, nearest);
}

}  // namespace palpate
