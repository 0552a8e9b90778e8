// Chooses scale, stiffness and region for exploring a scene by a simulated hand.
#include "palpate/device/exploration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "base/requirement.hpp"
#include "device/explore.hpp"
#include "device/explored_tool.hpp"
#include "field/formulas.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kReach = 0.3;          // m across; reach of a hand on a desk (judgement)
constexpr double kRegion = 0.6;         // m across; explored in some seconds ... (judgement)
constexpr double kRegionRadii = 20;     // ... or, if that is more, so many R (judgement)
constexpr double kDepth = 0.75;         // R under the surface (judgement)
constexpr double kLargestForce = 4;     // N (judgement)
constexpr double kPaperMultiple = 2.5;  // m = R / s if s is unknown (docs/method.md 5.3, the paper)
// N that the usual hand and device take at 0.3 m/s, the fastest (3.5 N s/m and 0.05 N of friction)
constexpr double kLeastForce = 1.1;
// times the force of the deepest press: what friction on the surface and its slope take besides
// (judgement)
constexpr double kHarder = 1.1;
constexpr float kUpward = 0.7F;  // of a normal's z: within 45 degrees of up (judgement)
// m of the hand from the surface to the device's origin (judgement)
constexpr double kStandoff = 2e-3;

// All sources' points, relative to one origin. A single source's are not copied: it may be large.
struct Union {
  std::vector<std::shared_ptr<const SurfacePoints>> sources;
  Vector3d origin = Vector3d::Zero();
  std::vector<Vector3f> points;
  std::vector<Vector3f> normals;
  Box box;
  double radius = 0;   // of the source with most points
  double spacing = 0;  // of the same source; 0: unknown

  [[nodiscard]] ExploredSurface view() const {
    if (sources.size() > 1) return {origin, points, normals};
    return {origin, sources.front()->grid.points(), sources.front()->normals};
  }
};

void append(Union& all, const SurfacePoints& source) {
  const Vector3f shift = (source.origin - all.origin).cast<float>();
  for (const Vector3f& p : source.grid.points()) all.points.push_back(p + shift);
  if (source.normals.empty()) {
    all.normals.resize(all.points.size(), Vector3f::Zero());
  } else {
    all.normals.insert(all.normals.end(), source.normals.begin(), source.normals.end());
  }
}

// A large cloud's surface begins around the tools; the rest of it is there soon.
void extend_by_what_follows(const Source& source, Union& all) {
  const std::shared_ptr<const PointCloud> overview = source.state().overview;
  for (std::size_t k = 0; overview && k < overview->size(); ++k) {
    all.box.extend(overview->point(k) - all.origin);
  }
}

Union unite(const Scene& scene) {
  Union all;
  std::size_t most = 0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> source = scene.source(i).points();
    if (!source || source->size() == 0) continue;
    if (all.sources.empty()) all.origin = source->origin;
    all.sources.push_back(source);
    const CellGrid::Cell& root = source->grid.cells().front();
    const Vector3d shift = source->origin - all.origin;
    all.box.extend(root.lower.cast<double>() + shift);
    all.box.extend(root.upper.cast<double>() + shift);
    extend_by_what_follows(scene.source(i), all);
    if (source->size() > most) {
      all.radius = source->radius;
      all.spacing = scene.source(i).report().spacing;
    }
    most = std::max(most, source->size());
  }
  if (all.sources.empty()) throw Error("nothing to explore: no source has any points");
  if (all.sources.size() > 1) {
    for (const auto& source : all.sources) append(all, *source);
  }
  return all;
}

// Height of the rendered surface above the points, m.
double offset(const FieldOptions& field, const Union& all, double tool_radius) {
  if (field.kind != FieldOptions::Kind::metaball) return tool_radius;
  double level = field.threshold;
  if (field.raw_weights) {
    const double multiple = all.spacing > 0 ? all.radius / all.spacing : kPaperMultiple;
    level /= multiple * multiple * plane_integral(field.kernel);
  }
  return plane_offset(field.kernel, level) * all.radius + tool_radius;
}

double choose_scale(double region, double stiffness) {
  const double scale = workspace_scale(region);
  if (stiffness == 0 || scale * stiffness <= kSteadyStiffness) return scale;
  return std::min(scale, std::max(1.0, kSteadyStiffness / stiffness));
}

void validate(const ExplorationOptions& options) {
  const Requirement require{"exploration"};
  require.positive("scale", options.scale.value_or(1), "give a scale above 0, or none");
  require.not_negative("stiffness (N/m)", options.stiffness, "give one of 0 or more");
  require.not_negative("tool_radius (m)", options.tool_radius, "give one of 0 or more");
  require.positive("rate (1/s)", options.rate, "give a rate above 0");
  require(options.hand.stiffness > 0, "hand.stiffness (N/m)", options.hand.stiffness,
          "give one above 0; infinite: a hand that does not yield");
}

// Size of the region and the scale that follows; exploring and placing share it.
struct Extent {
  double region = 0;  // m across
  double scale = 1;
  double stiffness = 0;  // N/m in the world
};

Extent extent_of(const Union& all, const ExplorationOptions& options) {
  const double widest = std::max(kRegion, kRegionRadii * all.radius);
  Extent extent;
  extent.region = std::max(std::min(all.box.size().maxCoeff(), widest), all.radius);
  extent.scale = options.scale.value_or(choose_scale(extent.region, options.stiffness));
  extent.stiffness =
      options.stiffness > 0 ? options.stiffness : ProxyOptions().stiffness / extent.scale;
  return extent;
}

// Hand and surface are springs in a row: the hand has to want more than it gets.
StrokeOptions strokes_of(const Placement& plan, const FieldOptions& field, const Union& all,
                         const ExplorationOptions& options) {
  const double scale = plan.workspace.scale;
  const double felt = plan.workspace.felt_stiffness(plan.stiffness);
  StrokeOptions strokes;
  strokes.duration = options.duration;
  strokes.period = 1 / options.rate;
  strokes.radius = all.radius;
  strokes.depth = plan.depth * (1 + felt / options.hand.stiffness);
  strokes.offset = offset(field, all, options.tool_radius);
  strokes.tool = options.tool;
  strokes.region = plan.region;
  strokes.slide_speed = scale * std::clamp(0.5 * plan.region / scale, 0.05, 0.2);
  strokes.travel_speed = scale * std::clamp(plan.region / scale, 0.1, 0.3);
  strokes.seed = options.seed;
  strokes.progress = options.progress;
  return strokes;
}

// Upward where there is none.
Vector3f normal_at(const ExploredSurface& surface, std::size_t point) {
  const bool has_normal = !surface.normals.empty() && !surface.normals[point].isZero();
  return has_normal ? surface.normals[point] : Vector3f::UnitZ();
}

// The point over which a hand that comes down meets the surface nearest to its middle; where
// nothing looks up, the one that is nearest to it.
std::size_t standing_point(const ExploredSurface& surface) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3f& p : surface.points) sum += p.cast<double>();
  const Vector3f middle = (sum / static_cast<double>(surface.points.size())).cast<float>();
  struct Nearest {
    std::size_t point = 0;
    float distance = std::numeric_limits<float>::infinity();  // squared
    void take(std::size_t i, float d) {
      if (d < distance) *this = {i, d};
    }
  };
  Nearest across;
  Nearest any;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vector3f offset = surface.points[i] - middle;
    any.take(i, offset.squaredNorm());
    if (normal_at(surface, i).z() >= kUpward) across.take(i, offset.head<2>().squaredNorm());
  }
  return std::isfinite(across.distance) ? across.point : any.point;
}

}  // namespace

double workspace_scale(double extent) {
  const double wanted = extent / kReach;
  if (wanted >= 0.2 && wanted <= 4) return 1;
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (wanted <= step * decade) return step * decade;
  }
  return 10 * decade;
}

Placement plan_exploration(const Scene& scene, const FieldOptions& field,
                           const ExplorationOptions& options) {
  validate(options);
  const Union all = unite(scene);
  Placement plan;
  const Extent extent = extent_of(all, options);
  const double scale = extent.scale;
  plan.region = extent.region;
  plan.workspace.scale = scale;
  plan.stiffness = extent.stiffness;
  plan.depth = std::min(kDepth * all.radius, kLargestForce / plan.stiffness);

  plan.force = std::max(kLeastForce, kHarder * plan.depth * plan.stiffness);

  const StrokeOptions strokes = strokes_of(plan, field, all, options);
  plan.target = explore(all.view(), strokes, &plan.presses);

  Box path;
  for (const TrajectoryRow& row : plan.target) path.extend(row.position);
  plan.workspace.T_world_device.translation() = path.center();
  for (TrajectoryRow& row : plan.target) {
    row.position = plan.workspace.position_to_device(row.position);
  }
  const double felt = plan.workspace.felt_stiffness(plan.stiffness);
  // Held, a hand stays behind its target by this share of the target's depth; half of it
  // distinguishes a hand that is held from one that is not.
  const double held = felt / (felt + options.hand.stiffness);
  for (Press& press : plan.presses) {
    press.pull *= 0.5 * held / scale;
    for (Vector3d& corner : press.over) corner = plan.workspace.position_to_device(corner);
  }
  return plan;
}

Placement place_device(const Scene& scene, const FieldOptions& field,
                       const ExplorationOptions& options) {
  validate(options);
  const Union all = unite(scene);
  const ExploredSurface surface = all.view();
  const Extent extent = extent_of(all, options);
  const std::size_t point = standing_point(surface);
  const Vector3d normal = normal_at(surface, point).cast<double>();
  const double reach = ExploredTool(options.tool).reach(normal);
  const double height = offset(field, all, options.tool_radius) + reach + kStandoff * extent.scale;
  Placement placement;
  placement.region = extent.region;
  placement.stiffness = extent.stiffness;
  placement.workspace.scale = extent.scale;
  placement.workspace.T_world_device.translation() =
      surface.origin + surface.points[point].cast<double>() + height * normal;
  return placement;
}

}  // namespace palpate
