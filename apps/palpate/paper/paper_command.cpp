#include "apps/palpate/paper/paper_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/sources/load.hpp"

namespace palpate::app {

namespace {

constexpr const char* kPaperFooter = R"(Examples:
  palpate paper fig5 --picture fig5.png
  palpate paper fig7 --picture fig7.png --csv fig7.csv
  palpate paper fig7 camera:simulated:still,noise=c
  palpate paper fig7 sequence:recording --duration 2

The paper is A. Leeper, S. Chan, K. Salisbury: Point Clouds Can Be Represented as Implicit Surfaces
for Constraint-Based Haptic Rendering, ICRA 2012.)";

void add_common(CLI::App& command, PaperOptions& o) {
  command
      .add_option("source", o.source,
                  wrapped("a simulated camera or a sequence (default: camera:simulated:still, a "
                          "table viewed as in the paper)"))
      ->type_name("SOURCE");
  command.add_option("--csv", o.csv, "the data as CSV; - is standard output")->type_name("FILE");
  command.add_option("--picture", o.picture, "the figure as PNG (needs python3-matplotlib)")
      ->type_name("FILE.png");
  command.footer(kPaperFooter);
}

CLI::App* add_fig5(CLI::App& command, PaperOptions& o) {
  CLI::App* fig5 = command.add_subcommand(
      "fig5", "Preparation times at the paper's four cloud sizes, compared with the paper's");
  add_common(*fig5, o);
  fig5->add_option("--repeats", o.repeats, "runs per measurement; the fastest counts (5)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  return fig5;
}

CLI::App* add_fig7(CLI::App& command, PaperOptions& o) {
  CLI::App* fig7 = command.add_subcommand("fig7",
                                          "Stability over time of a pressed surface: metaball and "
                                          "point-set with 1 to 4 clouds, and palpate");
  add_common(*fig7, o);
  fig7->add_option("--duration", o.duration, "length of the press, after 1 s to settle (4)")
      ->check(number("between 0.1 and 60 s", [](double x) { return x >= 0.1 && x <= 60; }))
      ->type_name("SECONDS");
  fig7->add_option("--voxel", o.voxel, "voxel size of the paper's clouds (0.004)")
      ->check(positive())
      ->type_name("METRES");
  fig7->add_option("--radius", o.radius, "R of the paper's clouds (2.5 times their spacing)")
      ->check(positive())
      ->type_name("METRES");
  return fig7;
}

// What the paper's figures are made of unless another source is named: a table seen from 0.7 m,
// 27 degrees from above, with the noise of a Kinect.
inline constexpr const char* kPaperSource = "camera:simulated:still";

// To be read as fast as it goes.
std::unique_ptr<DepthCamera> open_paper_source(const std::string& source) {
  if (!lives(source)) {
    throw UsageError(fmt::format(
        "{} is neither a camera nor a sequence; name one, e.g. sequence:FOLDER", source));
  }
  SourcePlan chosen;
  chosen.argument = {"source", source};
  return open_stream(chosen, nullptr);
}

// Every file is made before the work: a place that does not exist is told at once.
struct Outputs {
  std::optional<OutputFile> csv;
  std::optional<OutputFile> picture;

  explicit Outputs(const PaperOptions& options) {
    check_distinct({}, {{"--csv", options.csv}, {"--picture", options.picture}});
    check_picture(options.picture);
    if (!options.csv.empty()) csv.emplace(options.csv);
    if (!options.picture.empty()) picture.emplace(options.picture);
  }
};

template <class Figure>
void tell(const Figure& figure, const PaperOptions& options, Outputs& outputs) {
  print_figure(figure, options.source, options.csv == "-" ? stderr : stdout);
  const std::string table = csv(figure);
  write_whole(outputs.csv, table);
  if (!outputs.picture) return;
  const Waiting waiting("drawing the picture");
  draw_by_python(figures_script(),
                 {{"facts.json", facts(figure, options.source)}, {"table.csv", table}},
                 options.picture, *outputs.picture);
}

}  // namespace

void add_paper_options(CLI::App& command, PaperCommand& paper) {
  command.require_subcommand(0, 1);
  command.footer(kPaperFooter);
  paper.fig5 = add_fig5(command, paper.options);
  paper.fig7 = add_fig7(command, paper.options);
}

void paper(const PaperCommand& paper) {
  if (!paper.fig5->parsed() && !paper.fig7->parsed()) {
    throw UsageError("no figure given; use fig5 or fig7 (see 'palpate paper --help')");
  }
  PaperOptions options = paper.options;
  if (options.source.empty()) options.source = kPaperSource;
  Outputs outputs(options);
  const std::unique_ptr<DepthCamera> camera = open_paper_source(options.source);
  if (paper.fig5->parsed()) {
    tell(measure_fig5(*camera, options.repeats), options, outputs);
  } else {
    Fig7Options press;
    press.duration = options.duration;
    press.voxel = options.voxel.value_or(press.voxel);
    press.radius = options.radius;
    tell(measure_fig7(*camera, press), options, outputs);
  }
}

}  // namespace palpate::app
