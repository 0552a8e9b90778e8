// The command paper: repeats figures 5 and 7 of the paper.
#include "apps/palpate/paper/paper_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>
#include <memory>
#include <numbers>
#include <thread>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/sources/load.hpp"

namespace palpate::app {
namespace {

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

std::string label(const Press& press) {
  return press.clouds == 0 ? press.name : fmt::format("{} N = {}", press.name, press.clouds);
}

// The name of a column of the log.
std::string key(const Press& press) {
  return press.clouds == 0 ? press.name : fmt::format("{}_{}", press.name, press.clouds);
}

const char* radius_text(const Fig7& figure) {
  return figure.radius_given ? "R given" : "R = 2.5 s";
}

void print_figure(const Fig5& figure, const std::string& source, std::FILE* out) {
  const Style style(out);
  fmt::print(out,
             "{} preparation of clouds in ms: paper (Core i7-950, 2012) and here ({} cores, "
             "fastest run)\n",
             style.heading("fig 5"), std::thread::hardware_concurrency());
  fmt::print(out, "{:>8} {:>8} {:>8}   {:^15}   {:^15}   {:^15}   {:^17}\n", "points", "here",
             "voxel", "index", "normals", "spacing", "sum");
  fmt::print(out, "{:>8} {:>8} {:>8}   {:>7} {:>7}   {:>7} {:>7}   {:>7} {:>7}   {:>7} {:>9}\n", "",
             "", "", "paper", "here", "paper", "here", "paper", "here", "paper", "here");
  for (const Fig5Row& row : figure.rows) {
    fmt::print(out,
               "{:>8} {:>8} {:>8}   {:>7.4g} {:>7.3g}   {:>7.4g} {:>7.3g}   {:>7.4g} {:>7.3g}   "
               "{:>7.4g} {:>7.3g} x{:<.0f}\n",
               row.points, row.points_here, length(row.voxel), row.paper.index, row.here.index,
               row.paper.normals, row.here.normals, row.paper.spacing, row.here.spacing,
               row.paper.sum(), row.here.sum(), row.paper.sum() / row.here.sum());
  }
  fmt::print(
      out,
      "points from {} ({} pixels with depth), reduced to the paper's sizes by a voxel filter\n",
      source, grouped(figure.pixels));
  fmt::print(out,
             "the whole frame as a depth stream, filtered and touchable everywhere: {:.3g} ms of "
             "computation\n",
             figure.everywhere);
}

void print_figure(const Fig7& figure, const std::string& source, std::FILE* out) {
  const Style style(out);
  fmt::print(
      out, "{} hand pressed into {}: {} from the camera, viewing angle {:.0f} degrees; {} frames\n",
      style.heading("fig 7"), source, length(figure.depth), degrees(figure.angle), figure.frames);
  fmt::print(out, "{:<18} {:>9} {:>11} {:>9} {:>9} {:>12} {:>8}\n", "", "R", "height, sd",
             "n_x, sd", "n_y, sd", "force step", "contact");
  for (const Press& press : figure.presses) {
    fmt::print(out, "{:<18} {:>9} {:>11} {:>7.2f} ° {:>7.2f} ° {:>10.3f} N {:>6.0f} %\n",
               label(press), length(press.radius), length(press.height_sd), degrees(press.nx_sd),
               degrees(press.ny_sd), press.jump, 100 * press.touching);
  }
  fmt::print(out,
             "metaball and point-set as in the paper: T = 0.5, {}, voxels of {}, N clouds, hard "
             "swap\nnormals of the field at the proxy: n_x along the view, n_y across; force step: "
             "largest change per servo step\n",
             radius_text(figure), length(figure.voxel));
}

// A row a size; ms.
std::string csv(const Fig5& figure) {
  std::string text =
      "points,points_here,voxel_m,paper_index_ms,index_ms,paper_normals_ms,normals_ms,"
      "paper_spacing_ms,spacing_ms,weights_ms\n";
  for (const Fig5Row& row : figure.rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", row.points, row.points_here, row.voxel,
                        row.paper.index, row.here.index, row.paper.normals, row.here.normals,
                        row.paper.spacing, row.here.spacing, row.weights);
  }
  return text;
}

// A row a servo step: t (s), then height (m), nx, ny and force (N) of each method of feeling.
std::string csv(const Fig7& figure) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "t");
  for (const Press& press : figure.presses) {
    fmt::format_to(out, ",{0}_height,{0}_nx,{0}_ny,{0}_force", key(press));
  }
  fmt::format_to(out, "\n");
  for (std::size_t i = 0; i < figure.times.size(); ++i) {
    fmt::format_to(out, "{:.3f}", figure.times[i]);
    for (const Press& press : figure.presses) {
      const PressSample& s = press.samples[i];
      fmt::format_to(out, ",{:.7g},{:.6g},{:.6g},{:.5g}", s.height, s.nx, s.ny, s.force);
    }
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

// Input of figures.py.
Json facts(const Fig5& figure, const std::string& source) {
  Json rows = Json::array();
  for (const Fig5Row& row : figure.rows) {
    const auto times = [](const PrepareTimes& t) { return Json{t.index, t.normals, t.spacing}; };
    rows.push_back({{"points", row.points},
                    {"points_here", row.points_here},
                    {"paper_ms", times(row.paper)},
                    {"here_ms", times(row.here)}});
  }
  return Json{{"figure", "fig5"},
              {"source", source},
              {"cores", std::thread::hardware_concurrency()},
              {"everywhere_ms", figure.everywhere},
              {"rows", rows}};
}

Json facts(const Fig7& figure, const std::string& source) {
  Json presses = Json::array();
  for (const Press& press : figure.presses) {
    presses.push_back({{"name", press.name},
                       {"clouds", press.clouds},
                       {"key", key(press)},
                       {"radius_m", press.radius},
                       {"height_sd_m", press.height_sd},
                       {"nx_sd_degrees", degrees(press.nx_sd)},
                       {"ny_sd_degrees", degrees(press.ny_sd)},
                       {"jump_N", press.jump}});
  }
  return Json{{"figure", "fig7"},        {"source", source},
              {"depth_m", figure.depth}, {"angle_degrees", degrees(figure.angle)},
              {"voxel_m", figure.voxel}, {"radius", radius_text(figure)},
              {"presses", presses}};
}

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
constexpr const char* kPaperSource = "camera:simulated:still";

// Opens a source that is read as fast as it can be.
std::unique_ptr<DepthCamera> open_paper_source(const std::string& source) {
  if (!lives(source)) {
    throw UsageError(fmt::format(
        "{} is neither a camera nor a recording; name one, e.g. sequence:FOLDER", source));
  }
  SourcePlan chosen;
  chosen.argument = {"source", source};
  return open_stream(chosen, nullptr);
}

template <class Figure>
void write_figure(const Figure& figure, const PaperOptions& options, FigureFiles& files) {
  print_figure(figure, options.source, options.csv == "-" ? stderr : stdout);
  files.write(csv(figure), facts(figure, options.source));
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
  FigureFiles files(options.csv, "", options.picture);
  const std::unique_ptr<DepthCamera> camera = open_paper_source(options.source);
  if (paper.fig5->parsed()) {
    write_figure(measure_fig5(*camera, options.repeats), options, files);
  } else {
    Fig7Options press;
    press.duration = options.duration;
    press.voxel = options.voxel.value_or(press.voxel);
    press.radius = options.radius;
    write_figure(measure_fig7(*camera, press), options, files);
  }
}

}  // namespace palpate::app
