#pragma once

#include <memory>
#include <vector>

#include "apps/palpate/cloud_facts.hpp"
#include "apps/palpate/load.hpp"
#include "apps/palpate/touch_options.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::app {

/// The paper's K and ours, N/m.
inline constexpr double kStiffness = 500;

/// The field that the command line asks for.
[[nodiscard]] FieldOptions field_options(const TouchOptions& options);

/// The smallest R that a tool of the size asked for can be felt with, m.
[[nodiscard]] double smallest_radius(const TouchOptions& options);

/// The proxy that it asks for, with a surface of `stiffness` N/m.
[[nodiscard]] ProxyOptions proxy_options(const TouchOptions& options, double stiffness);

/// What one cloud of a run is, for the report. Points themselves live in the scene.
struct TouchedCloud {
  CloudArgument argument;
  std::string format;
  std::size_t declared = 0;
  std::size_t dropped = 0;
  double read_seconds = 0;
  UnitsGuess units;            ///< of a file that was read without --scale
  double prepare_seconds = 0;  ///< wall time of everything between reading and touching
};

/// Reads every cloud, prepares it and puts it into `scene`.
/// @throws UsageError when a pose names no cloud; Error as reading and preparing do.
[[nodiscard]] std::vector<TouchedCloud> fill(Scene& scene, const TouchOptions& options);

/// Does the command line ask for a material that follows the intensity?
[[nodiscard]] bool wants_material(const TouchOptions& options);

/// @throws UsageError when the texture would be carved deeper than the thinnest surface of `scene`
/// reaches, so that no hand could meet it.
void check_texture(const TouchOptions& options, const Scene& scene);

/// What the softest points feel like, where the hardest ones have `stiffness` N/m.
/// @throws UsageError when they would be harder than these.
[[nodiscard]] SoftMaterial soft_material(const TouchOptions& options, double stiffness);

/// Puts into `scene` what `prepared` holds, shared, with another soft material: how hard the
/// hardest points are may be known after preparation only.
void fill_softened(Scene& scene, const Scene& prepared, const SoftMaterial& soft);

}  // namespace palpate::app
