// The command tile: writes clouds of any size as a store whose parts can be read one by one.
#include "apps/palpate/tile/tile_command.hpp"

#include <CLI/CLI.hpp>
#include <optional>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/report/report.hpp"
#include "extras/tile/tile.hpp"
#include "session/length_unit.hpp"

namespace palpate::app {

namespace {

constexpr const char* kTileFooter = R"(Examples:
  palpate tile scan-*.laz site.las --out site
  palpate tile survey.las --scale 0.3048 --out survey
  palpate tile synthetic:terrain:2e7 --out terrain

Ctrl-C stops it, and the same command goes on from there. docs/large_clouds.md says more.

Exit codes: 0 done, 1 an input is bad or the disk is full, 2 the command line is wrong.)";

}  // namespace

void add_tile_options(CLI::App& command, TileCommand& tile) {
  command
      .add_option("clouds", tile.inputs,
                  wrapped("LAS, LAZ or COPC, of any size; other clouds are read whole; or "
                          "synthetic:terrain:N, N points of made terrain"))
      ->required()
      ->type_name("CLOUD");
  command
      .add_option("--out", tile.out, "folder of the store (Potree 2.0); made if it is not there")
      ->required()
      ->type_name("FOLDER");
  command
      .add_option_function<std::string>(
          "--scale", [&tile](const std::string& text) { take_scale(text, tile.reading); },
          wrapped("metres per unit of the files: 0.001 for millimetres, 0.3048 for feet; 0.3048,1 "
                  "where heights are in metres (what each file states, or as for touch)"))
      ->type_name("FACTOR");
  command.add_flag("--force", tile.force,
                   wrapped("replace a store that is complete, or was begun with other inputs"));
  add_json_option(command, tile.json);
  command.footer(kTileFooter);
}

void tile(const TileCommand& command) {
  std::vector<NamedFile> inputs;
  for (const std::string& each : command.inputs) inputs.push_back({"the cloud", file_of(each)});
  check_distinct(inputs, {{"--json", command.json}});
  std::optional<OutputFile> json = output_at(command.json);
  std::optional<Progress> progress;
  std::string shown;
  io::tile::TileOptions options;
  options.reading = command.reading;
  options.force = command.force;
  options.progress = [&](const std::string& step, double done) {
    if (step != shown) progress.emplace(step);
    shown = step;
    progress->update(done);
  };
  const io::tile::TileResult result = io::tile::tile(command.inputs, command.out, options);
  progress.reset();
  Report report(command.out, "Potree 2.0, encoding DEFAULT");
  report.data = {{"folder", command.out}};
  report.row("points", "{points}[, {dropped} dropped]", result.points, result.dropped);
  report.row("octree",
             "{octree_bytes} bytes, coordinates in steps of {step_m}, {spacing_m} between points "
             "of the root",
             result.bytes, result.step, result.spacing);
  for (const io::tile::TileResult::Input& input : result.inputs) {
    const session::UnitsGuess units = session::units_of(input.unit, input.format, input.box);
    report.item("inputs", {"units", units.advice.empty() ? Mark::plain : Mark::warning},
                "{name}: {units}, {reason}[; {advice}]", input.name, units.units, units.reason,
                units.advice);
  }
  report.print(command.json == "-" ? stderr : stdout);
  write_whole(json, text_of(report.data));
}

}  // namespace palpate::app
