// Makes the first blocks of a large cloud, or of a store on disk, a surface.
#include "apps/palpate/sources/large_cloud.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <vector>

#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "session/length_unit.hpp"

namespace palpate::app {
namespace {

// Bytes that a point takes while a cloud is read and prepared as a whole. Measured: 10.6 million
// points of an airborne survey took 2.1 GB.
constexpr double kWholeBytes = 200;

// The points in the axes of their file again.
PointCloud in_file(PointCloud cloud, const Eigen::Isometry3d& T_world_file) {
  const Eigen::Isometry3d back = T_world_file.inverse();
  cloud.origin = back * cloud.origin;
  for (Eigen::Vector3f& p : cloud.positions) p = back.linear().cast<float>() * p;
  return cloud;
}

void warn(const std::string& problem) {
  fmt::print(stderr, "{}\n", without_controls(problem));
}

const Source& first_surface(Scene& scene, LoadedSource& result) {
  Source& source = scene.add(result.plan.argument.name, result.plan.options);
  const auto is_empty = [&] { return !source.points() || source.points()->size() == 0; };
  std::exception_ptr first;
  std::vector<std::string> problems;
  for (bool more = true; more && is_empty();) {
    if (result.plan.reading.progress) result.plan.reading.progress(1);  // it was read
    try {
      more = result.on_demand->advance(source, 0);
    } catch (const std::exception& error) {
      if (!first) first = std::current_exception();
      problems.push_back(missing_part(source, error));
    }
  }
  if (is_empty() && first) std::rethrow_exception(first);
  for (const std::string& problem : problems) warn(problem);
  return source;
}

// A run may need more than what is around tools.
void refuse_needs_of_whole(const LoadedSource& result, const LoadOptions& options) {
  const SourcePlan& plan = result.plan;
  const char* needs = nullptr;
  if (plan.options.prepare.material_from_intensity) {
    needs = "--soft-stiffness and --soft-friction need";
  }
  if (plan.reading.length) needs = "--length needs";
  if (plan.options.prepare.paper) needs = "the paper's preparation needs";
  if (options.recorded) needs = "--record needs";
  if (needs == nullptr) return;
  throw Error(
      fmt::format("{} all of {} in memory, which is more than --cache allows; remove it, or give a "
                  "larger --cache",
                  needs, plan.argument.path));
}

}  // namespace

std::string missing_part(const Source& source, const std::exception& error) {
  return fmt::format("{}: {} (what needs it is not there; it is tried again after 10 s)",
                     source.name(), error.what());
}

bool advance(OnDemand& cloud, Source& source, double now) {
  try {
    return cloud.advance(source, now, false);
  } catch (const std::exception& error) {
    warn(missing_part(source, error));
    return true;
  }
}

bool show_again(OnDemand& cloud, Source& source) {
  while (!source.points() && advance(cloud, source, 0)) continue;
  return source.points() != nullptr;
}

const Source& add_on_demand(Scene& scene, const std::shared_ptr<const PointCloud>& cloud,
                            LoadedSource& result) {
  const SourceOptions& options = result.plan.options;
  result.on_demand = std::make_unique<OnDemand>(cloud, options.prepare, options.T_world_sensor);
  return first_surface(scene, result);
}

bool add_store(Scene& scene, const LoadOptions& options, LoadedSource& result) {
  using Clock = std::chrono::steady_clock;
  const SourcePlan& plan = result.plan;
  const auto begin = Clock::now();
  const auto store = open_store(plan.argument.path, plan.reading);
  if (!store) return false;
  const PointStore::Layout& layout = store->layout();
  const double whole = kWholeBytes * static_cast<double>(layout.points);
  if (whole <= static_cast<double>(plan.cache)) return false;
  refuse_needs_of_whole(result, options);
  const Waiting waiting(
      fmt::format("opening {} ({} points)", plan.argument.name, grouped(layout.points)));
  result.format = layout.format;
  result.declared = layout.points;
  const auto opened = Clock::now();
  result.read_seconds = std::chrono::duration<double>(opened - begin).count();
  result.on_demand = std::make_unique<OnDemand>(store, plan.options.prepare,
                                                plan.options.T_world_sensor, plan.cache);
  result.paged = true;
  const Source& source = first_surface(scene, result);
  result.prepared = source.report();
  const PointCloud seen = in_file(*source.state().overview, plan.options.T_world_sensor);
  result.unit = layout.unit;
  result.units = session::units_of(layout.unit, layout.format, session::core_of(seen));
  result.prepare_seconds = std::chrono::duration<double>(Clock::now() - opened).count();
  return true;
}

}  // namespace palpate::app
