// Makes a scene of named sources and feeds it with frames.
#include "apps/palpate/sources/loaded_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/sources/large_cloud.hpp"
#include "apps/palpate/sources/load.hpp"
#include "apps/palpate/sources/preparing.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/spacing.hpp"
#include "scene/bounds.hpp"
#include "session/frames.hpp"

namespace palpate::app {

namespace {

using WallClock = std::chrono::steady_clock;

double seconds_since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

void refuse_material(const CloudArgument& source) {
  throw Error(
      fmt::format("--soft-stiffness and --soft-friction need an intensity per point, but {} has "
                  "only depths; remove them",
                  source.path));
}

// The median of what was measured, m; 0: nothing was.
double middle_depth(const DepthFrame& frame) {
  std::vector<float> depths;
  std::ranges::copy_if(frame.depth, std::back_inserter(depths),
                       [](float z) { return z > 0 && std::isfinite(z); });
  return median(depths);
}

// What sets the metres a step of a source's depths, as words after others; cameras report theirs.
std::string unit_advice(const std::string& path) {
  const std::string name = path.starts_with(kCamera) ? path.substr(kCamera.size()) : path;
  if (name.starts_with(kBag) || name.starts_with(kRos)) {
    return fmt::format(", or give the metres a step of depth: {},unit=METRES", path);
  }
  if (name.starts_with(kSequence))
    return ", or correct the metres a step, depth_unit_m in its sequence.json";
  return lives(path) ? "" : ", or give the metres a step (--depth-unit)";
}

// Refuses a frame that measured something, and nothing in range: its unit may be another one.
void check_range(const CloudArgument& source, const DepthFrame& frame,
                 const DepthFilterOptions& range) {
  const auto out = [&](float z) {
    return !(static_cast<double>(z) >= range.nearest && static_cast<double>(z) <= range.farthest);
  };
  if (!std::ranges::all_of(frame.depth, out)) return;
  const double middle = middle_depth(frame);
  if (middle == 0) return;
  throw Error(
      fmt::format("{}: all depths are nearer than {} m or farther than {} m (median {:.4g} m); "
                  "widen the range (--nearest, --farthest){}",
                  source.path, range.nearest, range.farthest, middle, unit_advice(source.path)));
}

// Farther away the proxy would fault in every step.
void check_position(const CloudArgument& cloud, const Source& source) {
  const Box box = bounds_of(source);
  const double far = std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
  if (box.empty() || far <= Proxy::kLargestCoordinate) return;
  throw Error(fmt::format(
      "{} extends {:.4g} m from the origin; surfaces beyond {:.0e} m cannot be resolved: {} right?",
      cloud.path, far, Proxy::kLargestCoordinate,
      lives(cloud.path) ? "is --pose" : "are --scale and --pose"));
}

// Where R reaches over all of a cloud there is no surface any more, and preparing it takes long.
void check_radius(const CloudArgument& cloud, const PrepareOptions& options, const CellGrid& grid) {
  if (!options.radius || grid.size() == 0) return;
  const CellGrid::Cell& root = grid.cells().front();
  const auto across = static_cast<double>((root.upper - root.lower).norm());
  if (*options.radius <= across) return;
  constexpr double kFarBeyond = 100;  // spacings
  const double spacing = mean_spacing(grid);
  if (*options.radius <= kFarBeyond * spacing) return;
  throw Error(
      fmt::format("--radius {:.4g} is too large for {}, which is only {} across; remove it, or "
                  "give a few times the point spacing ({})",
                  *options.radius, cloud.path, length(across), length(spacing)));
}

void check_felt(const Source& source, LoadedSource& result) {
  const std::shared_ptr<const SurfacePoints> points = source.points();
  if (!points || points->size() == 0) {
    throw Error(fmt::format(
        "{} contains no surface, so there is nothing to touch; check its units and range",
        result.plan.argument.path));
  }
  check_position(result.plan.argument, source);
  check_radius(result.plan.argument, result.plan.options.prepare, points->grid);
  result.state = source.state();
}

void add_cloud(Scene& scene, const LoadOptions& options, std::optional<LoadedCloud> read,
               LoadedSource& result) {
  const SourcePlan& plan = result.plan;
  if (add_store(scene, options, result)) {
    return check_felt(scene.source(scene.size() - 1), result);
  }
  LoadedCloud loaded = read ? *std::move(read) : load(plan.argument, plan.reading);
  if (plan.options.prepare.material_from_intensity) check_intensities(loaded);
  check_voxel(loaded, plan.options.prepare);
  result.format = loaded.file.format;
  result.declared = loaded.file.declared;
  result.dropped = loaded.file.dropped;
  result.mesh = loaded.file.mesh;
  result.read_seconds = loaded.seconds;
  result.splats = loaded.file.splats;
  result.unit = loaded.file.unit;
  result.units = session::units_of(loaded.file, session::core_of(loaded.file.cloud));
  const auto cloud = std::make_shared<const PointCloud>(std::move(loaded.file.cloud));
  SourceOptions told = plan.options;
  if (told.prepare.radius) check_radius(loaded.argument, told.prepare, CellGrid(cloud->positions));
  const bool large = options.on_demand && OnDemand::suits(*cloud, plan.options.prepare);
  const Preparing preparing(loaded.argument.name, *cloud, large, told.prepare);
  const auto start = WallClock::now();
  const Source& source =
      large ? add_on_demand(scene, cloud, result) : scene.add(loaded.argument.name, *cloud, told);
  result.plan.reading.progress = {};  // nobody waits for it any more
  result.prepare_seconds = seconds_since(start);
  result.prepared = source.report();
  result.state = source.state();
  result.depth_image = result.state.depth > 0;
  if (result.depth_image) result.lens = depth_frame_of(*cloud).frame->camera;
  check_position(plan.argument, source);
  if (options.keep_clouds || large) result.cloud = cloud;
}

// Sensors that match patterns put false matches far behind everything; a true surface that far has
// too few and too coarse points to be touched.
void believe_no_farther(const DepthFrame& frame, SourcePlan& plan) {
  constexpr double kFarBeyond = 10;  // times the median depth
  if (plan.farthest) return;
  DepthFilterOptions& options = plan.options.depth;
  const double farthest = kFarBeyond * middle_depth(frame);
  if (farthest > options.nearest) options.farthest = std::min(options.farthest, farthest);
}

void add_depth_image(Scene& scene, bool keep, LoadedSource& result) {
  SourcePlan& plan = result.plan;
  const auto begin = WallClock::now();
  DepthFrame frame = load_depth_image(plan.argument.path, plan.reading);
  frame.stamp = 0;
  result.read_seconds = seconds_since(begin);
  result.format = fmt::format("depth image, {} x {}", frame.camera.width, frame.camera.height);
  result.depth_image = true;
  believe_no_farther(frame, plan);
  const Waiting waiting(fmt::format("preparing {}", plan.argument.name));
  const auto start = WallClock::now();
  Source& source = scene.add(plan.argument.name, plan.options);
  check_range(plan.argument, frame, plan.options.depth);
  source.set(frame);
  check_felt(source, result);
  result.prepare_seconds = seconds_since(start);
  if (keep) result.image = std::make_shared<DepthFrame>(std::move(frame));
}

// Makes it the first frame of the source. False: it shows no surface; `problem` gets the reason, if
// one is reported.
bool shows(const DepthFrame& frame, const LoadedSource& result, Source& source,
           std::string& problem) {
  try {
    push_frame(result, source, frame, [] { return 0.0; });  // in which there is no tool yet
  } catch (const Error& error) {
    problem = error.what();
    return false;
  }
  return source.points() && source.points()->size() > 0;
}

bool take_next(DepthCamera& camera, double latest, DepthFrame& frame) {
  try {
    frame = first_frame(camera);
  } catch (const Error&) {
    return false;
  }
  return frame.stamp <= latest;
}

// The camera of a frame. For an organised cloud, a camera that sees it in its own axes; size 0 if
// there is none.
CameraModel lens_of(const DepthFrame& frame) {
  if (!frame.cloud) return frame.camera;
  const std::optional<DepthFrame> image = depth_frame_of(*frame.cloud).frame;
  return image && !image->T_world_sensor ? image->camera : CameraModel{};
}

void add_stream(Scene& scene, const LoadOptions& options, LoadedSource& result) {
  constexpr double kFirstLook = 1;  // s of frames, the first of which may be black
  SourcePlan& plan = result.plan;
  result.camera = open_stream(plan, options.clock);
  DepthFrame first = first_frame(*result.camera);
  const double latest = first.stamp + kFirstLook;
  plan.as_cloud |= first.cloud != nullptr;
  const DepthFilterOptions given = plan.options.depth;
  Source& source = scene.add(plan.argument.name, plan.options);
  std::string problem;
  do {
    result.lens = lens_of(first);
    result.posed = first.T_world_sensor.has_value();
    plan.options.depth = given;
    believe_no_farther(first, plan);
    source.change(plan.options);  // forgets the frames before
    if (first.T_world_sensor) source.set_pose(*first.T_world_sensor);
    if (!options.explored) return;
    if (shows(first, result, source, problem)) return check_felt(source, result);
  } while (take_next(*result.camera, latest, first));
  if (!problem.empty()) throw Error(problem);
  check_felt(source, result);
}

bool is_filtered_image(const SourcePlan& plan) {
  return plan.kind == SourceKind::depth_image && !plan.as_cloud;
}

}  // namespace

std::string title_of(const LoadedScene& loaded) {
  std::string title;
  for (const LoadedSource& source : loaded.sources) {
    title += fmt::format("{}{}", title.empty() ? "" : " + ", source.plan.argument.name);
    if (!source.mesh || source.mesh->spacing == 0) continue;
    title += fmt::format(" (mesh of {} triangles, felt as {} points)",
                         grouped(source.mesh->triangles), grouped(source.prepared.points_in));
  }
  return title;
}

bool in_picture_axes(const LoadedScene& loaded) {
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    const LoadedSource& source = loaded.sources[i];
    const bool picture = source.depth_image || (source.camera && source.lens.width > 0);
    if (!picture || source.posed) return false;
    if (!loaded.scene.source(i).pose().linear().isIdentity(1e-9)) return false;
  }
  return true;
}

LoadedScene load_sources(const std::vector<SourcePlan>& sources, const LoadOptions& options) {
  LoadedScene loaded;
  auto read = load_in_one_unit(sources);
  for (const SourcePlan& plan : sources) {
    LoadedSource& source = loaded.sources.emplace_back();
    source.plan = plan;
    const bool depths = plan.kind == SourceKind::stream || is_filtered_image(plan);
    if (depths && plan.options.prepare.material_from_intensity) refuse_material(plan.argument);
    if (plan.kind == SourceKind::stream) {
      add_stream(loaded.scene, options, source);
    } else if (is_filtered_image(plan)) {
      add_depth_image(loaded.scene, options.keep_clouds, source);
    } else {
      add_cloud(loaded.scene, options, std::move(read[loaded.sources.size() - 1]), source);
    }
  }
  return loaded;
}

void begin_run(LoadedScene& loaded, const SourceOptions::SoftMaterial& soft) {
  Scene scene;
  for (std::size_t i = 0; i < loaded.sources.size(); ++i) {
    const LoadedSource& from = loaded.sources[i];
    SourceOptions options = from.plan.options;
    options.soft = soft;
    Source& source = scene.add(from.plan.argument.name, options);
    if (from.camera || (from.on_demand && show_again(*from.on_demand, source))) continue;
    session::publish_surface(loaded.scene.source(i), source);
  }
  loaded.scene = std::move(scene);
}

void push_frame(const LoadedSource& from, Source& to, const DepthFrame& frame,
                const Source::StartTime& start) {
  if (!from.plan.as_cloud && !frame.cloud) {
    check_range(from.plan.argument, frame, from.plan.options.depth);
    to.push(frame, start);
    return;
  }
  if (frame.T_world_sensor) to.set_pose(*frame.T_world_sensor);
  to.push(frame.cloud ? *frame.cloud : session::cloud_of(frame), frame.stamp, start);
}

}  // namespace palpate::app
