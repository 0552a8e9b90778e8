#include "apps/palpate/options/touch_usage.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/options/chosen_source.hpp"
#include "apps/palpate/options/depth_file.hpp"
#include "apps/palpate/options/device_choice.hpp"
#include "apps/palpate/options/option_uses.hpp"
#include "apps/palpate/options/touch_surface.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {

namespace {

// A day: longer ones are times in another unit, or broken.
constexpr double kLongestRun = 86'400;  // s

void check_files(const TouchOptions& options) {
  std::vector<CloudArgument> clouds;
  for (const ChosenSource& source : choose_sources(options)) clouds.push_back(source.argument);
  for (const CloudArgument& cloud : clouds) {
    require(cloud.path != "-" || options.trajectory != "-",
            "standard input (-) can be read only once");
  }
  require(options.log != "-" || options.json != "-",
          "--log and --json cannot both go to standard output");
  std::vector<NamedFile> read = inputs(clouds);
  read.push_back({"--trajectory", options.trajectory});
  read.push_back({"--setup", options.setup});
  std::vector<NamedFile> written = {{"--json", options.json}};
  for (std::size_t hand = 0; hand < choose_devices(options).size(); ++hand) {
    written.push_back({"--log", numbered_path(options.log, hand)});
    written.push_back({"--picture", numbered_path(options.picture, hand)});
  }
  check_distinct(read, written);
}

void check_surface(const TouchOptions& options) {
  const bool metaball = field_options(options).kind == FieldKind::metaball;
  require(metaball || options.gradient != "printed",
          "--gradient printed is eq. (4) of the metaball; add --field metaball");
  require(
      !metaball || options.gradient != "normal",
      "--gradient normal needs normals, which a metaball does without; give --field pointset or "
      "balanced");
  require(options.preset != "paper" || options.tool_radius == 0,
          "--preset paper touches with a point; leave --tool-radius out");
}

void check_source(const TouchOptions& options, const ChosenSource& source) {
  const SourceOptions checked = source_options(options, source);  // parses what is text
  const double smallest = smallest_radius(options);
  if (checked.prepare.radius && *checked.prepare.radius < smallest) {
    throw UsageError(
        fmt::format("--radius {} is too small for --tool-radius {}; it must be {:.4g} "
                    "at least",
                    *checked.prepare.radius, options.tool_radius, smallest));
  }
  require(!checked.policy.policy || *checked.policy.policy != Policy::morph ||
              !(source.choices.unorganised || options.preset == "paper"),
          "--policy morph is for depth images with rows and columns; leave --unorganised and "
          "--preset paper out or choose another policy");
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

bool in_real_time(const TouchOptions& options) {
  if (options.view.wanted || need_real_time(choose_devices(options))) return true;
  const std::vector<ChosenSource> sources = choose_sources(options);
  return !options.simulated_time && std::ranges::any_of(sources, [](const ChosenSource& source) {
    return lives(source.argument.path);
  });
}

bool has_page(const TouchOptions& options) {
  return in_real_time(options) && is_viewed(options.view);
}

void check_usage(const TouchOptions& options) {
  check_devices(options);
  check_files(options);
  check_surface(options);
  check_feel(options);
  const std::vector<ChosenSource> sources = choose_sources(options);
  for (const ChosenSource& source : sources) check_source(options, source);
  check_use(options, sources);
  check_picture(options.picture);
}

void check_trajectory(const TouchOptions& options, const Trajectory& trajectory) {
  if (trajectory.empty()) return;
  const double duration = trajectory.back().time - trajectory.front().time;
  const bool simulated = std::ranges::any_of(choose_devices(options), [](const auto& device) {
    return device.kind == DeviceKind::simulated;
  });
  if (simulated && duration > kLongestRun) {
    throw UsageError(
        fmt::format("--trajectory lasts {:.6g} s; --device simulated plays {:.0f} s at most: are "
                    "its times in seconds?",
                    duration, kLongestRun));
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
