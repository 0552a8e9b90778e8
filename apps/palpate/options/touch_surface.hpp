#pragma once

#include "apps/palpate/options/chosen_source.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::app {

/// The paper's K and ours, N/m.
inline constexpr double kStiffness = 500;

/// The field that the command line asks for.
[[nodiscard]] FieldOptions field_options(const TouchOptions& options);

/// How a source is prepared and, where it lives, treated in time.
/// @throws UsageError when a text of `source` makes no sense.
[[nodiscard]] SourceOptions source_options(const TouchOptions& options, const ChosenSource& source);

/// Are depths of this source taken as clouds, as the paper does, and not by the depth filter?
[[nodiscard]] bool taken_as_cloud(const TouchOptions& options, const ChosenSource& source);

/// What becomes of frames; `cloud`: they are taken as clouds.
[[nodiscard]] Policy policy_of(const SourceOptions& options, bool cloud);

/// Is --history a policy's?
[[nodiscard]] bool keeps_history(Policy policy);

/// The smallest R that a tool of the size asked for can be felt with, m.
[[nodiscard]] double smallest_radius(const TouchOptions& options);

/// The proxy that it asks for, with a surface of `stiffness` N/m.
[[nodiscard]] ProxyOptions proxy_options(const TouchOptions& options, double stiffness);

/// Does the command line ask for a material that follows the intensity?
[[nodiscard]] bool wants_material(const TouchOptions& options);

/// The largest amplitude of a texture, m, that a hand can meet on the thinnest surface of `scene`;
/// infinite where it has none.
[[nodiscard]] double deepest_texture(const Scene& scene);

/// @throws UsageError when the texture would be carved deeper than the thinnest surface of `scene`
/// reaches, so that no hand could meet it.
void check_texture(const TouchOptions& options, const Scene& scene);

/// What the softest points feel like, where the hardest ones have `stiffness` N/m.
/// @throws UsageError when they would be harder than these.
[[nodiscard]] SoftMaterial soft_material(const TouchOptions& options, double stiffness);

}  // namespace palpate::app
