#include "apps/palpate/options/touch_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/names.hpp"

namespace palpate::app {

namespace {

// The relief goes 2 amplitudes deep, and weights run out at about half an R under the points.
constexpr double kDeepestTexture = 0.2;  // R

FieldKind field_kind(const TouchOptions& options) {
  const FieldKind preset = options.preset == "paper" ? FieldKind::metaball : FieldOptions{}.kind;
  return choice_of(kFields, options.field).value_or(preset);
}

Kernel kernel(const TouchOptions& options) {
  return choice_of(kKernels, options.kernel).value_or(Kernel::wyvill);
}

PrepareOptions prepare_options(const TouchOptions& options, const SourceChoices& choices) {
  PrepareOptions result;
  result.voxel = choices.voxel;
  result.radius = choices.radius;
  result.minimum_radius = smallest_radius(options);
  result.normal_error = choices.normal_error.value_or(result.normal_error);
  result.kernel = kernel(options);
  result.paper = options.preset == "paper";
  result.material_from_intensity = wants_material(options);
  if (!choices.viewpoint.empty()) {
    result.viewpoint = parse_point(choices.viewpoint, "--viewpoint");
    result.orientation = Orientation::viewpoint;
  }
  return result;
}

// A recording's last surface stays; a sensor that falls silent is no longer believed.
PolicyOptions policy_options(const TouchOptions& options, const ChosenSource& source) {
  PolicyOptions result;
  const SourceChoices& choices = source.choices;
  result.policy = choice_of(kPolicies, choices.policy);
  if (!result.policy && options.preset == "paper") result.policy = Policy::average;
  result.history = choices.history.value_or(result.history);
  result.silence = choices.silence.value_or(result.silence);
  result.fade = choices.fade.value_or(result.fade);
  result.fit_everywhere = choices.fit_everywhere;
  result.clip_to_reach = choices.clip_to_reach;
  return result;
}

DepthFilterOptions depth_options(const SourceChoices& choices) {
  DepthFilterOptions result;
  if (!choices.noise.empty()) result.noise = parse_noise(choices.noise);
  result.normal_error = choices.normal_error.value_or(result.normal_error);
  result.memory = choices.memory.value_or(result.memory);
  result.nearest = choices.nearest.value_or(result.nearest);
  result.farthest = choices.farthest.value_or(result.farthest);
  if (result.nearest < result.farthest) return result;
  throw UsageError(fmt::format("--nearest {} is not below --farthest {}; no depth is between them",
                               result.nearest, result.farthest));
}

}  // namespace

SourceOptions source_options(const TouchOptions& options, const ChosenSource& source) {
  SourceOptions result;
  result.T_world_sensor = source.pose;
  result.prepare = prepare_options(options, source.choices);
  result.policy = policy_options(options, source);
  result.depth = depth_options(source.choices);
  result.organised = !taken_as_cloud(options, source);
  return result;
}

bool taken_as_cloud(const TouchOptions& options, const ChosenSource& source) {
  return source.choices.unorganised || options.preset == "paper" ||
         source.choices.policy == "fusion";
}

Policy policy_of(const SourceOptions& options, bool cloud) {
  return options.policy.policy.value_or(cloud ? kCloudPolicy : kDepthPolicy);
}

bool keeps_history(Policy policy) {
  return policy == Policy::average || policy == Policy::crossfade;
}

FieldOptions field_options(const TouchOptions& options) {
  const FieldKind kind = field_kind(options);
  FieldOptions result;
  result.kind = kind;
  if (options.preset == "paper") result = paper_field(kind);
  if (!options.kernel.empty()) result.kernel = kernel(options);
  result.gradient = choice_of(kGradients, options.gradient).value_or(result.gradient);
  if (options.threshold) result.threshold = *options.threshold;
  result.tool_radius = options.tool_radius;
  if (!options.sharp_edges) result.sharp_edges = false;
  return result;
}

double smallest_radius(const TouchOptions& options) {
  return options.tool_radius / 0.3;
}

ProxyOptions proxy_options(const TouchOptions& options, double stiffness) {
  ProxyOptions result;
  result.stiffness = stiffness;
  result.friction.static_coefficient = options.friction_static.value_or(options.friction_dynamic);
  result.friction.dynamic_coefficient = options.friction_dynamic;
  result.friction.viscous = options.friction_viscous;
  result.texture.amplitude = options.texture_amplitude;
  result.texture.wavelength = options.texture_wavelength;
  if (options.preset == "paper") result.method = ProxyMethod::single_step;
  return result;
}

double deepest_texture(const Scene& scene) {
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> points = scene.source(i).points();
    if (points && points->size() > 0) largest = std::min(largest, kDeepestTexture * points->radius);
  }
  return largest;
}

void check_texture(const TouchOptions& options, const Scene& scene) {
  const double largest = deepest_texture(scene);
  if (options.texture_amplitude <= largest) return;
  throw UsageError(
      fmt::format("--texture-amplitude {} is carved deeper than the surface reaches with its R; "
                  "give {:.2g} at most",
                  options.texture_amplitude, largest));
}

bool wants_material(const TouchOptions& options) {
  return options.soft_stiffness || options.soft_friction;
}

SoftMaterial soft_material(const TouchOptions& options, double stiffness) {
  SoftMaterial soft;
  soft.friction_factor = options.soft_friction.value_or(1);
  if (!options.soft_stiffness) return soft;
  if (*options.soft_stiffness > stiffness) {
    throw UsageError(
        fmt::format("--soft-stiffness {} is above the {:.4g} N/m of the hardest points; give less, "
                    "or a larger --stiffness",
                    *options.soft_stiffness, stiffness));
  }
  soft.stiffness_factor = *options.soft_stiffness / stiffness;
  return soft;
}

}  // namespace palpate::app
