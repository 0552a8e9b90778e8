#include "apps/palpate/options/touch_options.hpp"

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/options/device_choice.hpp"

namespace palpate::app {

namespace {

constexpr std::int64_t kLargestSeed = 1'000'000'000'000'000;

void add_surface_options(CLI::App& command, TouchOptions& o) {
  const std::string group = "Surface (chosen from the data unless given)";
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group(group);
  };
  add("--field", o.field, "how points become a surface: balanced (default), pointset or metaball")
      ->check(one_of(names_of(kFields)))
      ->type_name("NAME");
  add("--preset", o.preset,
      "default, or paper: the method of Leeper, Chan and Salisbury 2012 as they ran it")
      ->check(one_of({"default", "paper"}))
      ->type_name("NAME");
  add("--kernel", o.kernel, "wyvill (default) or wendland")
      ->check(one_of(names_of(kKernels)))
      ->type_name("NAME");
  add("--gradient", o.gradient,
      "of the metaball: exact (default), or as in the paper: normal (eq. 8) or printed (eq. 4 as "
      "printed, which points inward)")
      ->check(one_of(names_of(kGradients)))
      ->type_name("NAME");
  add("--threshold", o.threshold,
      "level of the metaball, 0 to 1; lower is farther out (0.4). Other fields become a "
      "metaball where normals cannot be trusted")
      ->check(number("between 0 and 1", [](double x) { return x > 0 && x < 1; }))
      ->type_name("LEVEL");
  add("--tool-radius", o.tool_radius, "radius of the ball that touches; 0: a point")
      ->check(not_negative())
      ->type_name("METRES");
}

void add_feel_options(CLI::App& command, TouchOptions& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group("Feel");
  };
  add("--stiffness", o.stiffness,
      "K of the surface, in the cloud's metres (500; less where a large cloud is explored)")
      ->check(number("above 0 and at most 1e9", [](double x) { return x > 0 && x <= 1e9; }))
      ->type_name("N/M");
  add("--soft-stiffness", o.soft_stiffness,
      "K where the cloud's intensity is lowest; it grows to --stiffness where that is highest")
      ->check(not_negative())
      ->type_name("N/M");
  add("--friction-static", o.friction_static,
      "coefficient while the proxy sticks (--friction-dynamic)")
      ->check(not_negative())
      ->type_name("MU");
  add("--friction-dynamic", o.friction_dynamic, "coefficient while it slides (0)")
      ->check(not_negative())
      ->type_name("MU");
  add("--friction-viscous", o.friction_viscous, "friction that grows with the speed of sliding (0)")
      ->check(not_negative())
      ->type_name("N S/M");
  add("--soft-friction", o.soft_friction,
      "share of the friction, 0 to 1, where the cloud's intensity is lowest; it grows to all of it "
      "where that is highest")
      ->check(number("between 0 and 1", [](double x) { return x >= 0 && x <= 1; }))
      ->type_name("SHARE");
  add("--texture-amplitude", o.texture_amplitude,
      "amplitude of a fine relief on the surface (0: none)")
      ->check(not_negative())
      ->type_name("METRES");
  add("--texture-wavelength", o.texture_wavelength, "wavelength of that relief (0.004)")
      ->check(positive())
      ->type_name("METRES");
}

void add_hand_options(CLI::App& command, TouchOptions& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group("Hand");
  };
  add("--trajectory", o.trajectory,
      "CSV with columns t,hip_x,hip_y,hip_z (s, m): one servo step a row; a log will do")
      ->type_name("FILE");
  add_device_option(command, o.devices, "Hand");
  add("--duration", o.duration,
      "how long the built-in exploration goes on (10); where it is given, a run with a remote "
      "device "
      "or a page ends then, too (without it by Ctrl-C)")
      ->check(number("between 0.01 and 3600 s", [](double x) { return x >= 0.01 && x <= 3600; }))
      ->type_name("SECONDS");
  add("--seed", o.seed,
      "which places the exploration touches: another number, other places (1; each further hand "
      "has the next number)")
      ->check(whole_number(0, kLargestSeed))
      ->type_name("N");
  add("--rate", o.rate,
      "steps a second of the exploration and of simulated and remote devices (1000)")
      ->check(number("between 500 and 10000 Hz", [](double x) { return x >= 500 && x <= 1e4; }))
      ->type_name("HZ");
}

void add_time_options(CLI::App& command, TouchOptions& o) {
  command
      .add_flag("--simulated-time", o.simulated_time,
                wrapped("cameras, preparation and servo on one simulated clock, as fast as they "
                        "go: the same command gives the same log. Files without a page do so "
                        "anyway"))
      ->group("Streams");
  command
      .add_option("--latency", o.latency,
                  wrapped("time from a frame's stamp until its surface is felt, in simulated time "
                          "(0.01)"))
      ->check(number("between 0 and 10 s", [](double x) { return x >= 0 && x <= 10; }))
      ->type_name("SECONDS")
      ->group("Streams");
}

void add_output_options(CLI::App& command, TouchOptions& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group("Output");
  };
  add("--log", o.log, "every servo step as a row of CSV; - is standard output")->type_name("FILE");
  add("--json", o.json, "the report as data; - is standard output")->type_name("FILE");
  add("--picture", o.picture, "cloud, path, proxy and force as PNG (needs python3-matplotlib)")
      ->type_name("FILE.png");
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

The log begins with t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,fx,fy,fz,us: seconds, metres in the
world frame, newtons on the hand (K (proxy - hip); in real time the force that the guard let pass),
microseconds of computing. The same input gives the same log but for us. With streams in simulated
time, t = 0 is the first frame's stamp. docs/touch.md explains log, report and picture.

Exit codes: 0 done, 1 the input or the run failed, 2 the command line is wrong.)";

}  // namespace

void add_placed_sources(CLI::App& command, TouchOptions& o) {
  command
      .add_option("sources", o.clouds,
                  wrapped(cloud_help() +
                          "; or a live source: camera:simulated[:SCENE], camera:openni2, "
                          "camera:freenect, sequence:FOLDER, or an .oni file ('palpate cameras' "
                          "lists what is there)"))
      ->type_name("SOURCE");
  command
      .add_option("--setup", o.setup,
                  wrapped("TOML file with sources, poses, surface, material, hand; the command "
                          "line overrides it (docs/setup.md)"))
      ->type_name("FILE")
      ->group("Reading");
  add_source_options(command, o.choices);
  command
      .add_option("--pose", o.poses,
                  wrapped("where a source's frame is in the world; once for each source that is "
                          "not at the world's origin"))
      ->type_name("NAME=X,Y,Z,QX,QY,QZ,QW")
      ->allow_extra_args(false)
      ->group("Reading");
}

void add_touch_options(CLI::App& command, TouchOptions& o) {
  add_placed_sources(command, o);
  add_surface_options(command, o);
  add_feel_options(command, o);
  add_hand_options(command, o);
  add_time_options(command, o);
  add_live_options(command, o.live);
  add_view_options(command, o.view);
  add_output_options(command, o);
  command.footer(kTouchFooter);
}

void add_setup_options(CLI::App& file, TouchOptions& o) {
  add_source_setup_options(file, o.choices);
  file.add_flag("--sharp-edges", o.sharp_edges);
  add_live_setup_options(file, o.live);
}

}  // namespace palpate::app
