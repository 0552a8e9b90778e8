#include "apps/palpate/touch_usage.hpp"

#include <fmt/format.h>

#include "apps/palpate/arguments.hpp"
#include "apps/palpate/distinct_files.hpp"
#include "apps/palpate/errors.hpp"
#include "apps/palpate/touch_surface.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {

namespace {

// A day: longer ones are times in another unit, or broken.
constexpr double kLongest = 86'400;  // s

void require(bool good, const char* what) {
  if (!good) throw UsageError(what);
}

void check_files(const TouchOptions& options) {
  const std::vector<CloudArgument> clouds = parse_clouds(options.load.clouds);
  for (const CloudArgument& cloud : clouds) {
    require(cloud.path != "-" || options.trajectory != "-",
            "standard input (-) can be read only once");
  }
  require(options.log != "-" || options.json != "-",
          "--log and --json cannot both go to standard output");
  require(options.picture != "-",
          "--picture cannot go to standard output; name a file such as a.png");
  std::vector<NamedFile> read = inputs(clouds);
  read.push_back({"--trajectory", options.trajectory});
  check_distinct(
      read, {{"--log", options.log}, {"--json", options.json}, {"--picture", options.picture}});
}

void check_surface(const TouchOptions& options) {
  const bool metaball = field_options(options).kind == FieldKind::metaball;
  require(metaball || options.gradient != "printed",
          "--gradient printed is eq. (4) of the metaball; add --field metaball");
  require(
      !metaball || options.gradient != "normal",
      "--gradient normal needs normals, which a metaball does without; give --field pointset or "
      "balanced");
  require(!metaball || !options.one_sided,
          "--one-sided means nothing to a metaball, which surrounds its points; leave it out or "
          "choose another --field");
  require(options.preset != "paper" || options.tool_radius == 0,
          "--preset paper touches with a point; leave --tool-radius out");
  const double smallest = smallest_radius(options);
  if (options.radius && *options.radius < smallest) {
    throw UsageError(
        fmt::format("--radius {} is too small for --tool-radius {}; it must be {:.4g} "
                    "at least",
                    *options.radius, options.tool_radius, smallest));
  }
}

void check_feel(const TouchOptions& options) {
  // Where a cloud is explored, K is known later, and checked again.
  const bool explored = options.trajectory.empty() && !options.stiffness;
  if (!explored) (void)soft_material(options, options.stiffness.value_or(kStiffness));
  if (options.friction_static && *options.friction_static < options.friction_dynamic) {
    throw UsageError(
        fmt::format("--friction-static {} is below --friction-dynamic {}; it must not be",
                    *options.friction_static, options.friction_dynamic));
  }
}

}  // namespace

void check_usage(const TouchOptions& options) {
  check_files(options);
  check_surface(options);
  check_feel(options);
  if (!options.viewpoint.empty()) (void)parse_point(options.viewpoint, "--viewpoint");
  if (!options.load.intrinsics.empty()) (void)parse_intrinsics(options.load.intrinsics);
  if (options.trajectory.empty()) return;
  require(!options.duration, "--duration is of the exploration; a --trajectory has its own");
  require(!options.seed, "--seed is of the exploration; a --trajectory is played as it is");
}

void check_trajectory(const TouchOptions& options, const Trajectory& trajectory) {
  if (trajectory.empty()) return;
  const double duration = trajectory.back().time - trajectory.front().time;
  if (options.device == "simulated" && duration > kLongest) {
    throw UsageError(
        fmt::format("--trajectory lasts {:.6g} s; --device simulated plays {:.0f} s at most: are "
                    "its times in seconds?",
                    duration, kLongest));
  }
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double far = trajectory[i].position.cwiseAbs().maxCoeff();
    if (far <= Proxy::kLargestCoordinate) continue;
    throw Error(
        fmt::format("row {} of {} is {:.4g} m from the origin; beyond {:.0e} m no surface can be "
                    "resolved: are its places in metres?",
                    i, options.trajectory, far, Proxy::kLargestCoordinate));
  }
}

}  // namespace palpate::app
