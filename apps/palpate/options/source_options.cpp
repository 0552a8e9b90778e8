#include "apps/palpate/options/source_options.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/option_checks.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate::app {

namespace {

std::string synthetic_list() {
  std::string list;
  for (const SyntheticName& each : synthetic_names()) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", each.name);
  }
  return list;
}

void add_surface_of_source(CLI::App& command, SourceChoices& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))
        ->group("Surface (chosen from the data unless given)");
  };
  add("--radius", o.radius,
      "support radius R of every point, of depth images and streams the smallest: larger is "
      "smoother")
      ->check(positive())
      ->type_name("METRES");
  add("--voxel", o.voxel, "edge of the voxel filter of clouds; 0: none")
      ->check(not_negative())
      ->type_name("METRES");
}

void add_stream_options(CLI::App& command, SourceChoices& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group("Streams");
  };
  add("--policy", o.policy,
      "how frames become one surface in time: replace (hard swap), average (of N, the paper), "
      "crossfade, fusion or morph (default of depth cameras)")
      ->check(one_of(names_of(kPolicies)))
      ->type_name("NAME");
  add("--history", o.history, "N of average and crossfade, 1 to 7 (4)")
      ->check(whole_number(1, 7))
      ->type_name("N");
  add("--silence", o.silence,
      "a surface that no frame has confirmed for this long begins to fade (0.3)")
      ->check(positive())
      ->type_name("SECONDS");
  add("--fade", o.fade, "time that it takes to fade away (0.5)")
      ->check(positive())
      ->type_name("SECONDS");
  add("--noise", o.noise,
      "standard deviation of a depth pixel, S0 + S1 z + S2 z^2 at z metres, and how much "
      "neighbours err together "
      "(C >= 1); or a sensor: kinect1, xtion, realsense, tof. Measured from the frames unless "
      "given")
      ->check(parsed_by([](const std::string& text) { (void)parse_noise(text); }))
      ->type_name("S0,S1,S2[,C]");
  add("--nearest", o.nearest, "the depth filter takes no depth nearer than this (0.1)")
      ->check(number("a depth of 0.001 m or more", [](double x) { return x >= 1e-3; }))
      ->type_name("METRES");
  add("--farthest", o.farthest,
      "the depth filter takes no depth beyond this (20, or ten times the first frame's median "
      "where that is less)")
      ->check(positive())
      ->type_name("METRES");
  command
      .add_flag("--clip-to-reach", o.clip_to_reach,
                wrapped("of frames taken as clouds, prepare only what the tool can reach before "
                        "the next one, as the paper does"))
      ->group("Streams");
  command.add_flag("--loop", o.loop, "sequences start again at their end")->group("Streams");
}

}  // namespace

std::string cloud_help() {
  return fmt::format(
      "[NAME=]FILE of type PLY, PCD, XYZ/TXT/CSV, OBJ, LAS, LAZ, depth PNG or PGM, any of them "
      "gzipped; - for standard input; or synthetic:NAME with NAME one of {}",
      synthetic_list());
}

void add_reading_options(CLI::App& command, ReadingOptions& o) {
  const auto add = [&](const std::string& name, auto& value, const std::string& help) {
    return command.add_option(name, value, wrapped(help))->group("Reading");
  };
  add("--scale", o.scale, "metres per unit of the file: 0.001 for millimetres, 0.3048 for feet (1)")
      ->check(positive())
      ->type_name("FACTOR");
  add("--intrinsics", o.intrinsics,
      "focal lengths and centre of a depth image, in pixels; a depth image needs them")
      ->check(parsed_by([](const std::string& text) { (void)parse_intrinsics(text); }))
      ->type_name("FX,FY,CX,CY");
  add("--depth-unit", o.depth_unit, "metres per step of a depth image's values (0.001)")
      ->check(positive())
      ->type_name("METRES");
}

void add_source_options(CLI::App& command, SourceChoices& o) {
  add_reading_options(command, o.reading);
  command
      .add_option("--viewpoint", o.viewpoint,
                  "where the sensor stood, in the cloud's frame: orients normals")
      ->check(parsed_by([](const std::string& text) { (void)parse_point(text, "--viewpoint"); }))
      ->type_name("X,Y,Z")
      ->group("Reading");
  command
      .add_flag("--unorganised", o.unorganised,
                wrapped("take depth images and organised clouds as loose points: voxel filter and "
                        "fitted normals in place of the depth filter"))
      ->group("Reading");
  add_surface_of_source(command, o);
  add_stream_options(command, o);
}

void add_source_setup_options(CLI::App& file, SourceChoices& o) {
  file.add_option("--memory", o.memory)->check(whole_number(1, 255));
  file.add_option("--normal-error", o.normal_error)
      ->check(number("an angle from 0.0005 to 0.2 rad",
                     [](double x) { return x >= 5e-4 && x <= 0.2; }));
  file.add_flag("--fit-everywhere", o.fit_everywhere);
}

}  // namespace palpate::app
