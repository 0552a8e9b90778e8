// Reads keyword arguments into option structs.
#include "options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/eigen.h>

#include <array>
#include <utility>
#include <variant>

#include "palpate/base/error.hpp"

namespace palpate::python {

bool Keywords::offer(const char* name) {
  offered_.emplace_back(name);
  return given_.contains(name);
}

void Keywords::refuse(const char* name) const {
  const auto given = py::repr(given_[name]).cast<std::string>();
  throw py::type_error(fmt::format("{}(): {} cannot be {}", function_, name, given));
}

void Keywords::refuse_choice(const char* name, const std::string& given,
                             const std::vector<std::string>& choices) {
  throw Error(
      fmt::format("{} cannot be '{}'; give one of: {}", name, given, fmt::join(choices, ", ")));
}

void Keywords::finish() const {
  for (const auto& [key, value] : given_) {
    const auto name = key.cast<std::string>();
    if (std::ranges::find(offered_, name) != offered_.end()) continue;
    throw py::type_error(fmt::format("{}() has no argument '{}'; these can be given: {}", function_,
                                     name, fmt::join(offered_, ", ")));
  }
}

namespace {

constexpr std::initializer_list<Named<Kernel>> kKernels = {{"wyvill", Kernel::wyvill},
                                                           {"wendland", Kernel::wendland}};

}  // namespace

void take(Keywords& keywords, PrepareOptions& options) {
  using Orientation = PrepareOptions::Orientation;
  std::optional<std::pair<Eigen::Vector3d, Eigen::Vector3d>> clip;
  keywords.take("voxel", options.voxel);
  keywords.take("radius", options.radius);
  keywords.take("smoothing", options.smoothing);
  keywords.take("minimum_radius", options.minimum_radius);
  keywords.take("normal_error", options.normal_error);
  keywords.take("viewpoint", options.viewpoint);
  keywords.take("orientation", options.orientation,
                {{"automatic", Orientation::automatic},
                 {"viewpoint", Orientation::viewpoint},
                 {"outward", Orientation::outward},
                 {"given", Orientation::given}});
  keywords.take("clip", clip);
  if (clip) options.clip = Box{clip->first, clip->second};
  keywords.take("remove_speckle", options.remove_speckle);
  keywords.take("estimate_normals", options.estimate_normals);
  keywords.take("material_from_intensity", options.material_from_intensity);
  keywords.take("paper", options.paper);
  keywords.take("kernel", options.kernel, kKernels);
}

void take(Keywords& keywords, PolicyOptions& options) {
  Policy policy{};
  if (keywords.take("policy", policy,
                    {{"replace", Policy::replace},
                     {"average", Policy::average},
                     {"crossfade", Policy::crossfade},
                     {"morph", Policy::morph}})) {
    options.policy = policy;
  }
  keywords.take("history", options.history);
  keywords.take("silence", options.silence);
  keywords.take("fade", options.fade);
  keywords.take("fit_everywhere", options.fit_everywhere);
  keywords.take("clip_to_reach", options.clip_to_reach);
}

void take(Keywords& keywords, DepthFilterOptions& options) {
  std::variant<std::monostate, std::string, std::array<double, 3>> noise;
  keywords.take("noise", noise);
  if (const auto* const name = std::get_if<std::string>(&noise))
    options.noise = sensor_noise(*name);
  if (const auto* const sigma = std::get_if<std::array<double, 3>>(&noise)) {
    options.noise = NoiseModel{.coefficients = *sigma};
  }
  keywords.take("normal_error", options.normal_error);
  keywords.take("memory", options.memory);
  keywords.take("nearest", options.nearest);
  keywords.take("farthest", options.farthest);
}

void take(Keywords& keywords, FieldOptions& options) {
  using Kind = FieldOptions::Kind;
  using Gradient = FieldOptions::Gradient;
  keywords.take(
      "kind", options.kind,
      {{"balanced", Kind::balanced}, {"pointset", Kind::pointset}, {"metaball", Kind::metaball}});
  bool paper = false;
  keywords.take("paper", paper);
  if (paper) options = paper_field(options.kind);
  keywords.take("kernel", options.kernel, kKernels);
  keywords.take(
      "gradient", options.gradient,
      {{"exact", Gradient::exact}, {"normal", Gradient::normal}, {"printed", Gradient::printed}});
  keywords.take("threshold", options.threshold);
  keywords.take("minimum_support", options.minimum_support);
  keywords.take("tool_radius", options.tool_radius);
  keywords.take("capped", options.capped);
  keywords.take("sharp_edges", options.sharp_edges);
}

void take(Keywords& keywords, ProxyOptions& options) {
  using Method = ProxyOptions::Method;
  keywords.take("stiffness", options.stiffness);
  keywords.take("friction_static", options.friction.static_coefficient);
  keywords.take("friction_dynamic", options.friction.dynamic_coefficient);
  keywords.take("friction_viscous", options.friction.viscous);
  keywords.take("texture_amplitude", options.texture.amplitude);
  keywords.take("texture_wavelength", options.texture.wavelength);
  keywords.take("method", options.method,
                {{"converged", Method::converged}, {"single_step", Method::single_step}});
  keywords.take("max_iterations", options.max_iterations);
  keywords.take("tangent_tolerance", options.tangent_tolerance);
  keywords.take("rise_time", options.rise_time);
}

void take(Keywords& keywords, GuardOptions& options) {
  keywords.take("maximum_force", options.maximum_force);
  keywords.take("slew", options.slew);
  keywords.take("damping", options.damping);
  keywords.take("soft_start", options.soft_start);
  keywords.take("stiffness_share", options.stiffness_share);
}

}  // namespace palpate::python
