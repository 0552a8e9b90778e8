// Options of a run that apply to all sources and hands.
#include "apps/palpate/options/touch_options.hpp"

#include <fmt/format.h>

#include <sstream>

#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/page_options.hpp"
#include "contact/description.hpp"
#include "field/description.hpp"
#include "servo/description.hpp"

namespace palpate::app {

namespace {

constexpr std::int64_t kLargestSeed = 1'000'000'000'000'000;

constexpr std::array<Named<bool>, 2> kPresets = {{{"default", false}, {"paper", true}}};

void add_field_options(OptionTable& table, TouchChoices& o) {
  FieldOptions& field = o.plan.surface.field;
  table.under("Surface (chosen from the data unless given)", "surface");
  table.add_choice("--field", o.field, kFields, described(field, field.kind).about.help);
  table.add_choice(
      "--preset", o.plan.surface.paper, kPresets,
      "default, or paper: the method of Leeper, Chan and Salisbury 2012 with their settings");
  table.add(field, field.kernel);
  table.add(described(field, field.gradient), o.gradient);
  table.add(described(field, field.threshold), o.threshold,
            number("between 0 and 1", [](double x) { return x > 0 && x < 1; }));
  table.add(field, field.tool_radius).only_for(kPoints);
  table.add(field, field.sharp_edges);
}

void add_material_options(OptionTable& table, TouchChoices& o) {
  SurfacePlan& surface = o.plan.surface;
  ProxyOptions& proxy = surface.proxy;
  table.under("Feel", "material");
  table.add(described(proxy, proxy.stiffness), surface.stiffness,
            number("above 0 and at most 1e9", [](double x) { return x > 0 && x <= 1e9; }));
  table.add("--soft-stiffness", surface.soft_stiffness, "N/M", not_negative(),
            "stiffness at the cloud's lowest intensity; rises to --stiffness at the highest");
  table.add(described(proxy, proxy.friction.static_coefficient), o.friction_static);
  table.add(proxy, proxy.friction.dynamic_coefficient);
  table.add(proxy, proxy.friction.viscous);
  table.add("--soft-friction", surface.soft_friction, "SHARE",
            number("between 0 and 1", [](double x) { return x >= 0 && x <= 1; }),
            "fraction of the friction, 0 to 1, at the cloud's lowest intensity; rises to full "
            "friction at the highest");
  table.add(proxy, proxy.texture.amplitude);
  table.add(proxy, proxy.texture.wavelength);
}

std::vector<std::string> list_of(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  return names;
}

void add_trajectory_options(OptionTable& table, MotionPlan& motion) {
  table
      .add("--trajectory", motion.trajectory, "FILE",
           "CSV with columns t,hip_x,hip_y,hip_z (s, m), perhaps qx,qy,qz,qw (how a tool is "
           "turned) and gripper (m open), one servo step per row; a log works too")
      .only_for({&RunFacts::follows,
                 "applies only to scripted and simulated devices; remote and hardware devices "
                 "supply their own motion"});
  table
      .add_text(
          "--columns", KeyKind::text, "NAMES",
          [&motion](const std::string& text) { motion.reading.columns = list_of(text); },
          "names of the trajectory's columns in their order, for text without a header line: "
          "t,hip_x,hip_y,hip_z, perhaps fx,fy,fz, qx,qy,qz,qw, gripper, and - for one to pass over")
      .only_for({&RunFacts::trajectory, "needs --trajectory"});
  table
      .add_flag("--compare", motion.reading.forces,
                "compare forces with the trajectory's columns fx,fy,fz (N, on the hand)")
      .only_for(
          {&RunFacts::played, "needs --trajectory, played by --device scripted in simulated time"});
}

void add_hand_options(OptionTable& table, TouchPlan& plan) {
  MotionPlan& motion = plan.motion;
  table.under("Hand", "hand");
  add_trajectory_options(table, motion);
  add_device_option(table, plan.devices);
  table.under("Hand", "tool");
  add_tool_options(table, plan.tool);
  table.under("Hand", "hand");
  table
      .add("--duration", motion.duration, "SECONDS",
           number("between 0.01 and 3600 s", [](double x) { return x >= 0.01 && x <= 3600; }),
           "length of the built-in exploration (10); also ends a run with a remote or hardware "
           "device or a page, which otherwise runs until Ctrl-C")
      .only_for({&RunFacts::has_duration,
                 "applies only to the exploration; a --trajectory has its own length"});
  table
      .add("--seed", motion.seed, "N", whole_number(0, kLargestSeed),
           "random seed of the exploration path (1; each further hand uses the next number)")
      .only_for({&RunFacts::explores,
                 "applies only to the exploration; a --trajectory is played back unchanged, and "
                 "remote and hardware devices supply their own motion"});
  table
      .add("--rate", motion.rate, "HZ",
           number("between 500 and 10000 Hz", [](double x) { return x >= 500 && x <= 1e4; }),
           "servo rate of the exploration and of simulated and remote devices (1000)")
      .only_for({&RunFacts::has_rate,
                 "applies only to the exploration and to --device simulated or remote; a "
                 "--trajectory has its own rate"});
}

void add_time_options(OptionTable& table, TouchChoices& o) {
  table.under("Streams", "stream");
  table.add_flag("--simulated-time", o.simulated_time,
                 "run cameras, preparation and servo on one simulated clock, as fast as possible: "
                 "the same command gives the same log. Files without a page always run this way");
  table
      .add("--latency", o.plan.time.latency, "SECONDS",
           number("between 0 and 10 s", [](double x) { return x >= 0 && x <= 10; }),
           "delay from a frame's timestamp until its surface can be felt, in simulated time (0.01)")
      .only_for({&RunFacts::stream,
                 "applies only to cameras and sequences; static sources have no latency"})
      .only_for(
          {&RunFacts::simulated_time, "applies only to simulated time; add --simulated-time"});
}

void add_view_options(OptionTable& table, TouchChoices& o) {
  table.under("Page");
  table
      .add_flag("--view", o.plan.page.wanted,
                "show the run on a page in a browser, where a mouse can move the tool; the run is "
                "in real time and lasts until --duration or Ctrl-C")
      .only_for({&RunFacts::any_time, "needs a run in real time; remove it or --simulated-time"});
  table
      .add_flag("--no-view", o.no_view,
                "no page; by default, real-time runs of cameras and sequences show one if started "
                "at a terminal")
      .only_for({&RunFacts::page_unasked, "contradicts --view; remove one of them"});
  add_page_options(table, o.plan.page);
}

void add_output_options(OptionTable& table, OutputPlan& outputs) {
  table.under("Output");
  table.add("--log", outputs.log, "FILE", "CSV with one row per servo step; - is standard output");
  table.add("--json", outputs.json, "FILE", "the report as JSON; - is standard output");
  table.add("--picture", outputs.picture, "FILE.png",
            "cloud, path, proxy and force as PNG (needs python3-matplotlib)");
  add_record_option(table, outputs);
}

constexpr const char* kTouchFooter = R"(Examples:
  palpate touch bunny.ply --picture bunny.png
  palpate touch synthetic:torus --friction-static 0.4 --friction-dynamic 0.3
  palpate touch scan.pcd --trajectory hand.csv --log forces.csv
  palpate touch left=a.ply right=b.ply --pose right=0.1,0,0,0,0,0,1
  palpate touch depth.png --intrinsics 525,525,319.5,239.5
  palpate touch camera:simulated --simulated-time --duration 5 --picture table.png
  palpate touch sequence:recording --simulated-time --trajectory hand.csv --log forces.csv
  palpate touch bunny.ply --view
  palpate touch bunny.ply --view --device simulated --device remote
  palpate touch --setup desk.toml left=sequence:monday
  gunzip -c dragon.ply.gz | palpate touch -

The log starts with t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,fx,fy,fz,us: seconds, metres in the
world frame, newtons on the hand (K (proxy - hip); in real time after the guard), microseconds of
computation. The same input gives the same log except for us. With streams in simulated time, t = 0
is the first frame's timestamp. docs/touch.md explains log, report and picture.

Exit codes: 0 done, 1 the input or the run failed, 2 the command line is wrong.)";

}  // namespace

void add_placed_sources(OptionTable& table, TouchChoices& o) {
  table.add_positional(
      "sources", o.sources, "SOURCE",
      cloud_help() +
          "; or a live source: camera:simulated[:SCENE], camera:openni2, camera:freenect, "
          "camera:remote[:PATH], sequence:FOLDER, bag:FILE[:TOPIC], ros:TOPIC, or an .oni file "
          "('palpate cameras' lists those available)");
  table.under("Reading");
  table.add("--setup", o.setup, "FILE",
            "TOML file with sources, poses, surface, material, hand; the command line overrides it "
            "(docs/setup.md)");
  add_source_options(table, o.every_source);
  table.under("Reading");
  table.add_texts(
      "--pose", KeyKind::numbers, "NAME=X,Y,Z,QX,QY,QZ,QW",
      [&o](const std::string& text) { o.poses.push_back(parse_pose(text)); },
      "pose of a source's frame in the world; repeat for each source that is not at the origin");
}

void add_live_options(OptionTable& table, TimePlan& time) {
  GuardOptions& guard = time.guard;
  RealtimeOptions& realtime = time.realtime;
  table.under("Real time", "guard");
  table.add(guard, guard.maximum_force).only_for(kGuarded);
  table.add(guard, guard.slew);
  const std::function<void(const double&)> watch = [&time](double silence) {
    time.guard.silence = silence;
    time.own_watchdog = true;
  };
  table.add_key("--watchdog", watch,
                number("a time from 0.001 to 1 s", [](double x) { return x >= 1e-3 && x <= 1; }));
  table.add(guard, guard.damping);
  table.add(described(guard, guard.soft_start), guard.soft_start,
            number("a time from 0 to 60 s", [](double x) { return x >= 0 && x <= 60; }));
  table.add_key("--passivity", guard.passivity.on);
  table.under("Real time", "servo");
  table
      .add("--processor", realtime.processor, "N", whole_number(0, 1023),
           "pin the servo thread to this CPU, counted from 0; ideally an isolated one (isolcpus=N)")
      .only_for(kGuarded);
  table.add_key("--priority", realtime.priority, whole_number(1, 99));
  table.add_key("--realtime", realtime.realtime_priority);
  table.add_key("--lock-memory", realtime.lock_memory);
}

void add_record_option(OptionTable& table, OutputPlan& outputs) {
  table.add(
      "--record", outputs.record, "FILE.mcap",
      "the whole run as an MCAP bag: steps, frames and all that 'palpate replay' does it again "
      "from (docs/bags.md)");
}

void add_touch_options(OptionTable& table, TouchChoices& o) {
  add_placed_sources(table, o);
  add_cache_option(table, o.every_source);
  add_field_options(table, o);
  add_material_options(table, o);
  add_hand_options(table, o.plan);
  add_time_options(table, o);
  add_live_options(table, o.plan.time);
  add_view_options(table, o);
  add_bridge_options(table, o.plan.ros);
  add_output_options(table, o.plan.outputs);
}

void add_touch_command(CLI::App& command, TouchChoices& choices) {
  OptionTable table(command);
  add_touch_options(table, choices);
  command.footer(kTouchFooter);
}

}  // namespace palpate::app
