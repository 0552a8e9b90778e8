// Checks all options together and makes the plan of a run.
#include "apps/palpate/options/touch_plan.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/plot/python_drawing.hpp"

namespace palpate::app {

namespace {

FieldOptions field_of(const TouchChoices& choices) {
  const SurfacePlan& surface = choices.plan.surface;
  FieldOptions field = surface.field;
  if (surface.paper) {
    field = paper_field(choices.field.value_or(FieldOptions::Kind::metaball));
    field.kernel = surface.field.kernel;
    field.tool_radius = surface.field.tool_radius;
  }
  field.kind = choices.field.value_or(field.kind);
  field.gradient = choices.gradient.value_or(field.gradient);
  field.threshold = choices.threshold.value_or(field.threshold);
  return field;
}

SurfacePlan surface_of(const TouchChoices& choices) {
  SurfacePlan surface = choices.plan.surface;
  surface.field = field_of(choices);
  Friction& friction = surface.proxy.friction;
  friction.static_coefficient = choices.friction_static.value_or(friction.dynamic_coefficient);
  if (surface.paper) surface.proxy.method = ProxyOptions::Method::single_step;
  return surface;
}

void check_surface(const TouchChoices& choices, const SurfacePlan& surface) {
  const bool metaball = surface.field.kind == FieldOptions::Kind::metaball;
  require(metaball || choices.gradient != FieldOptions::Gradient::printed,
          "--gradient printed applies only to the metaball (eq. 4); add --field metaball");
  require(!metaball || choices.gradient != FieldOptions::Gradient::normal,
          "--gradient normal needs normals, which the metaball does not use; give --field pointset "
          "or balanced");
  require(!surface.paper || surface.field.tool_radius == 0,
          "--preset paper uses a point tool; remove --tool-radius");
}

// Options of the command line are refused by their scopes; keys of a set-up file have none.
void check_tool(const TouchPlan& plan) {
  require(plan.tool.turns() || (!plan.tool.spacing && !plan.tool.turn_stiffness),
          "tool_spacing and turn_stiffness are of a tool that turns; add --tool");
  if (!plan.tool.turns()) return;
  const SurfacePlan& surface = plan.surface;
  require(surface.field.tool_radius == 0,
          "--tool-radius is of a point, and a --tool's shape is its own; remove one of them");
  require(!surface.paper, "--preset paper uses a point tool; remove --tool");
  require(!plan.ros.bridge.robot || !plan.tool.text.starts_with("gripper:"),
          "--robot tells where a tool is, and not how far it is open; give a --tool that is rigid");
}

// Where a cloud is explored, K is computed later, and checked again.
void check_material(const SurfacePlan& surface, bool explored) {
  if (surface.stiffness || !explored) {
    (void)surface.soft_material(surface.stiffness.value_or(kStiffness));
  }
  const Friction& friction = surface.proxy.friction;
  if (friction.static_coefficient >= friction.dynamic_coefficient) return;
  throw UsageError(
      fmt::format("--friction-static {} is below --friction-dynamic {}; give at least as much",
                  friction.static_coefficient, friction.dynamic_coefficient));
}

// Which devices there are, one a hand, and that they can be led and logged as they are to be.
std::vector<DevicePlan> devices_of(const TouchChoices& choices) {
  const MotionPlan& motion = choices.plan.motion;
  std::vector<DevicePlan> devices = choices.plan.devices;
  if (devices.empty()) {
    devices.push_back({motion.trajectory.empty() ? DeviceKind::simulated : DeviceKind::scripted});
  }
  const auto led = std::ranges::count_if(devices, &DevicePlan::follows_trajectory);
  require(!choices.simulated_time || !need_real_time(devices),
          "hardware, --device remote and several hands need real time; remove --simulated-time, or "
          "give one scripted or simulated device");
  require(motion.trajectory.empty() || led <= 1,
          "a --trajectory can drive only one device; remove it to let all of them explore, or give "
          "only one scripted or simulated device");
  require(devices.size() == 1 || choices.plan.outputs.log != "-",
          "several hands write one log each, so --log cannot go to standard output; name a file");
  check_devices(devices);
  return devices;
}

void check_files(const TouchPlan& plan, const std::string& setup) {
  const OutputPlan& outputs = plan.outputs;
  std::vector<CloudArgument> clouds;
  for (const SourcePlan& source : plan.sources) clouds.push_back(source.argument);
  for (const CloudArgument& cloud : clouds) {
    require(cloud.path != "-" || plan.motion.trajectory != "-",
            "standard input (-) can be read only once; give a file for the other input");
  }
  require(outputs.log != "-" || outputs.json != "-",
          "--log and --json cannot both go to standard output; name a file for one of them");
  std::vector<NamedFile> read = inputs(clouds);
  read.push_back({"--trajectory", plan.motion.trajectory});
  read.push_back({"--setup", setup});
  read.push_back({"--tool", mesh_file(plan.tool)});
  require(outputs.record != "-", "--record cannot go to standard output; name a file");
  std::vector<NamedFile> written = {{"--json", outputs.json}, {"--record", outputs.record}};
  for (std::size_t hand = 0; hand < plan.devices.size(); ++hand) {
    written.push_back({"--log", numbered_path(outputs.log, hand)});
    written.push_back({"--picture", numbered_path(outputs.picture, hand)});
  }
  check_distinct(read, written);
}

// Static sources have no need of real time.
bool in_real_time(const TouchPlan& plan, bool simulated_time) {
  if (plan.page.wanted || need_real_time(plan.devices)) return true;
  if (simulated_time) return false;
  return plan.ros.wanted() || std::ranges::any_of(plan.sources, [](const SourcePlan& source) {
           return source.kind == SourceKind::stream;
         });
}

// A page that was not requested is where a person is at the terminal.
bool is_watched(const TouchChoices& choices) {
  const bool person = isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0;
  return choices.plan.page.wanted || (person && !choices.no_view);
}

RunFacts facts_of(const TouchPlan& plan, const TouchChoices& choices) {
  const auto any = [&](DeviceKind kind) {
    return std::ranges::any_of(plan.devices,
                               [kind](const auto& each) { return each.kind == kind; });
  };
  RunFacts facts;
  for (const SourcePlan& source : plan.sources) add_facts(facts, source);
  facts.simulated_time = choices.simulated_time;
  facts.any_time = !choices.simulated_time;
  facts.guarded = plan.time.real_time && !choices.simulated_time;
  facts.robot = plan.ros.bridge.robot.has_value();
  facts.page = plan.page.served;
  facts.page_unasked = !plan.page.wanted;
  facts.follows = std::ranges::any_of(plan.devices, &DevicePlan::follows_trajectory);
  facts.explores = facts.follows && plan.motion.trajectory.empty();
  facts.trajectory = facts.follows && !facts.explores;
  facts.played = facts.trajectory && any(DeviceKind::scripted) && !plan.time.real_time;
  facts.has_duration = facts.explores || any(DeviceKind::remote) || any(DeviceKind::hardware);
  facts.turns = plan.tool.turns();
  facts.points = !facts.turns;
  facts.has_rate = facts.explores || any(DeviceKind::remote) || any(DeviceKind::simulated);
  return facts;
}

void name_frames(TouchPlan& plan) {
  for (DevicePlan& device : plan.devices) {
    std::string& frame = device.placement.frame;
    if (!frame.empty()) frame = camera_named(frame, plan.sources);
  }
}

}  // namespace

ProxyOptions SurfacePlan::proxy_of(double hardest) const {
  ProxyOptions result = proxy;
  result.stiffness = hardest;
  return result;
}

SourceOptions::SoftMaterial SurfacePlan::soft_material(double hardest) const {
  SourceOptions::SoftMaterial soft;
  soft.friction_factor = soft_friction.value_or(1);
  if (!soft_stiffness) return soft;
  if (*soft_stiffness > hardest) {
    throw UsageError(
        fmt::format("--soft-stiffness {} exceeds the largest stiffness, {:.4g} N/m; give less, or "
                    "a larger --stiffness",
                    *soft_stiffness, hardest));
  }
  soft.stiffness_factor = *soft_stiffness / hardest;
  return soft;
}

TouchPlan plan_touch(const CLI::App& command, TouchChoices choices) {
  const GivenOptions given = given_options(command);
  DescribedOptions described;
  CLI::App keys;
  OptionTable table(keys);
  add_touch_options(table, choices);
  if (!choices.setup.empty()) read_setup(choices.setup, table, given, choices, described);
  TouchPlan plan = choices.plan;
  plan.devices = devices_of(choices);
  plan.surface = surface_of(choices);
  const std::vector<DescribedSource> sources = choose_sources(choices, plan.surface);
  for (const DescribedSource& source : sources) plan.sources.push_back(source.plan);
  name_frames(plan);
  check_files(plan, choices.setup);
  check_surface(choices, plan.surface);
  check_material(plan.surface, plan.motion.trajectory.empty());
  plan.time.real_time = in_real_time(plan, choices.simulated_time);
  plan.page.served = plan.time.real_time && is_watched(choices);
  if (!plan.page.wanted) plan.page.headless = true;  // not requested: only its address is printed
  const RunFacts facts = facts_of(plan, choices);
  check_scopes(table, given, facts);
  check_scopes(table, described, facts);
  check_tool(plan);
  for (const DescribedSource& source : sources) {
    RunFacts its;
    add_facts(its, source.plan);
    check_scopes(table, source.described, its);
  }
  check_picture(plan.outputs.picture);
  return plan;
}

bool can_open_files(const TouchPlan& plan) {
  const OutputPlan& files = plan.outputs;
  const bool writes =
      !files.log.empty() || !files.json.empty() || !files.picture.empty() || !files.record.empty();
  const bool simulated = std::ranges::all_of(
      plan.devices, [](const DevicePlan& each) { return each.kind == DeviceKind::simulated; });
  return plan.page.served && simulated && !writes && !plan.ros.wanted();
}

namespace {

TouchPlan plan_of_choices(TouchPlan plan, const TouchChoices& choices) {
  plan.sources.clear();
  for (const DescribedSource& source : choose_sources(choices, plan.surface)) {
    plan.sources.push_back(source.plan);
  }
  plan.motion.trajectory.clear();
  for (DevicePlan& device : plan.devices) device.placement.frame.clear();
  plan.page.wanted = true;  // its hands explore until it is ended
  return plan;
}

}  // namespace

TouchPlan plan_of_sources(TouchPlan plan, const std::vector<std::string>& sources) {
  TouchChoices choices;
  choices.sources = sources;
  return plan_of_choices(std::move(plan), choices);
}

TouchPlan plan_in_unit(TouchPlan plan, std::size_t source, double metres) {
  FileReading& reading = plan.sources.at(source).reading;
  reading.scale = metres;
  reading.height_scale.reset();
  reading.chosen = true;
  reading.length.reset();
  plan.page.wanted = true;
  return plan;
}

TouchPlan plan_of_file(TouchPlan plan, const std::string& path) {
  TouchChoices choices;
  choices.sources = {path};
  if (plan.sources.size() == 1) {
    SourcePlan& like = choices.every_source = plan.sources.front();
    like.argument = {};
    like.options.T_world_sensor.setIdentity();
    if (like.options.prepare.viewpoint) like.options.prepare.orientation = {};
    like.options.prepare.viewpoint.reset();
    if (like.reading.chosen) {  // of the file before
      like.reading.chosen = false;
      like.reading.scale.reset();
    }
  }
  plan = plan_of_choices(std::move(plan), choices);
  require(plan.sources.front().kind != SourceKind::stream,
          "a page opens clouds and depth images, no recordings");
  return plan;
}

}  // namespace palpate::app
