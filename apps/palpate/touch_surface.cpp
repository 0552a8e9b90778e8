#include "apps/palpate/touch_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>

#include "apps/palpate/errors.hpp"
#include "apps/palpate/waiting.hpp"
#include "apps/palpate/words.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

// The relief goes 2 amplitudes deep, and weights run out at about half an R under the points.
constexpr double kDeepestTexture = 0.2;  // R

FieldKind field_kind(const TouchOptions& options) {
  if (options.field == "pointset") return FieldKind::pointset;
  if (options.field == "metaball") return FieldKind::metaball;
  if (options.field.empty() && options.preset == "paper") return FieldKind::metaball;
  return FieldKind::balanced;
}

Kernel kernel(const TouchOptions& options) {
  return options.kernel == "wendland" ? Kernel::wendland : Kernel::wyvill;
}

PrepareOptions prepare_options(const TouchOptions& options) {
  PrepareOptions result;
  result.voxel = options.voxel;
  result.radius = options.radius;
  result.minimum_radius = smallest_radius(options);
  result.kernel = kernel(options);
  result.paper = options.preset == "paper";
  result.material_from_intensity = wants_material(options);
  if (options.one_sided && options.viewpoint.empty()) result.orientation = Orientation::outward;
  if (!options.viewpoint.empty()) {
    result.viewpoint = parse_point(options.viewpoint, "--viewpoint");
    result.orientation = Orientation::viewpoint;
  }
  return result;
}

std::map<std::string, Eigen::Isometry3d> poses(const TouchOptions& options,
                                               const std::vector<CloudArgument>& clouds) {
  std::map<std::string, Eigen::Isometry3d> result;
  for (const std::string& text : options.poses) {
    const PoseArgument pose = parse_pose(text);
    const bool known = std::ranges::any_of(
        clouds, [&](const CloudArgument& cloud) { return cloud.name == pose.name; });
    if (!known) {
      std::string names;
      for (const CloudArgument& cloud : clouds) names += fmt::format(" {}", cloud.name);
      throw UsageError(
          fmt::format("--pose: no cloud is named '{}'; the names are{}", pose.name, names));
    }
    if (!result.emplace(pose.name, pose.pose).second) {
      throw UsageError(fmt::format("--pose: '{}' has two poses; give one", pose.name));
    }
  }
  return result;
}

void check_intensities(const LoadedCloud& loaded) {
  if (!loaded.file.cloud.intensities.empty()) return;
  throw Error(fmt::format(
      "--soft-stiffness and --soft-friction need a scalar for each point, but {} has no "
      "intensity column; leave them out or give a file with one",
      loaded.argument.path));
}

// Farther away the proxy would fault in every step.
void check_place(const CloudArgument& cloud, const SurfacePoints& points) {
  if (points.size() == 0) return;
  const CellGrid::Cell& root = points.grid.cells().front();
  const double far = std::max((points.origin + root.lower.cast<double>()).cwiseAbs().maxCoeff(),
                              (points.origin + root.upper.cast<double>()).cwiseAbs().maxCoeff());
  if (far <= Proxy::kLargestCoordinate) return;
  throw Error(fmt::format(
      "{} reaches {:.4g} m from the origin; beyond {:.0e} m no surface can be resolved: "
      "are --scale and --pose right?",
      cloud.path, far, Proxy::kLargestCoordinate));
}

TouchedCloud add(Scene& scene, const LoadedCloud& loaded, const SourceOptions& options) {
  TouchedCloud result{loaded.argument,
                      loaded.file.format,
                      loaded.file.declared,
                      loaded.file.dropped,
                      loaded.seconds,
                      {},
                      0};
  result.units = guess_units(core_of(loaded.file.cloud), loaded.file.format);
  const Waiting waiting(fmt::format("preparing {} ({} points)", loaded.argument.name,
                                    grouped(loaded.file.cloud.size())));
  const auto start = std::chrono::steady_clock::now();
  const Source& source = scene.add(loaded.argument.name, loaded.file.cloud, options);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  result.prepare_seconds = taken.count();
  check_place(loaded.argument, *source.points());
  return result;
}

}  // namespace

FieldOptions field_options(const TouchOptions& options) {
  const FieldKind kind = field_kind(options);
  FieldOptions result;
  result.kind = kind;
  if (options.preset == "paper") result = paper_field(kind);
  if (!options.kernel.empty()) result.kernel = kernel(options);
  if (options.gradient == "exact") result.gradient = GradientKind::exact;
  if (options.gradient == "normal") result.gradient = GradientKind::normal;
  if (options.gradient == "printed") result.gradient = GradientKind::printed;
  if (options.threshold) result.threshold = *options.threshold;
  result.tool_radius = options.tool_radius;
  if (options.one_sided) result.two_sided = false;
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

void check_texture(const TouchOptions& options, const Scene& scene) {
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    largest = std::min(largest, kDeepestTexture * scene.source(i).report().radius);
  }
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

void fill_softened(Scene& scene, const Scene& prepared, const SoftMaterial& soft) {
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    SourceOptions options = prepared.source(i).options();
    options.soft = soft;
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->layers.push_back({prepared.source(i).points(), 1, 1});
    scene.add(prepared.source(i).name(), options).publish(std::move(snapshot));
  }
}

std::vector<TouchedCloud> fill(Scene& scene, const TouchOptions& options) {
  const std::vector<CloudArgument> arguments = parse_clouds(options.load.clouds);
  const std::map<std::string, Eigen::Isometry3d> placed = poses(options, arguments);
  SourceOptions source;
  source.prepare = prepare_options(options);
  std::vector<TouchedCloud> clouds;
  for (const CloudArgument& argument : arguments) {
    const LoadedCloud loaded = load(argument, options.load);
    if (wants_material(options)) check_intensities(loaded);
    const auto pose = placed.find(argument.name);
    source.T_world_sensor = pose == placed.end() ? Eigen::Isometry3d::Identity() : pose->second;
    clouds.push_back(add(scene, loaded, source));
  }
  return clouds;
}

}  // namespace palpate::app
