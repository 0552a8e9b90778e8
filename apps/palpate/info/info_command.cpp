// The command info: options, density map and picture of trust.
#include "apps/palpate/info/info_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/sources/cloud_facts.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/source.hpp"
#include "session/length_unit.hpp"

namespace palpate::app {
namespace {

constexpr int kMostRows = 24;
constexpr std::string_view kShades = ".:-=+*#%@";
// From dark blue to yellow in the terminal's palette of 256.
constexpr std::array<int, 9> kColors = {17, 18, 24, 30, 36, 71, 106, 142, 220};

// A count's step: each is a factor of about 1.6 below the next, and the last holds the largest.
std::size_t shade(std::size_t count, std::size_t largest) {
  const double share = static_cast<double>(count) / static_cast<double>(largest);
  const double below = -2 * std::log2(share) / std::log2(2.5);
  const auto steps = static_cast<std::size_t>(below);
  return steps >= kShades.size() ? 0 : kShades.size() - 1 - steps;
}

}  // namespace

DensityMap map_density(const PointCloud& cloud, int columns) {
  const Box box = session::core_of(cloud);
  const Eigen::Vector3d size = box.size();
  Eigen::Index shortest = 0;
  size.minCoeff(&shortest);
  DensityMap map;
  map.horizontal = shortest == 0 ? 1 : 0;
  map.vertical = shortest == 2 ? 1 : 2;
  const double width = size[map.horizontal];
  const double height = size[map.vertical];
  map.cell = std::max({width / columns, height / (2 * kMostRows), 1e-12});
  map.columns = std::clamp(static_cast<int>(std::ceil(width / map.cell)), 1, columns);
  map.rows = std::clamp(static_cast<int>(std::ceil(height / (2 * map.cell))), 1, kMostRows);
  map.counts.resize(map.index(map.rows, 0));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!box.contains(cloud.point(i))) continue;
    const Eigen::Vector3d p = cloud.point(i) - box.lower;
    const int column = std::min(static_cast<int>(p[map.horizontal] / map.cell), map.columns - 1);
    const int row = std::min(static_cast<int>(p[map.vertical] / (2 * map.cell)), map.rows - 1);
    ++map.counts[map.index(map.rows - 1 - row, column)];
  }
  return map;
}

std::string draw(const DensityMap& map, bool colored) {
  const std::size_t largest = *std::max_element(map.counts.begin(), map.counts.end());
  std::string text;
  for (int row = 0; row < map.rows; ++row) {
    text += "  ";
    for (int column = 0; column < map.columns; ++column) {
      const std::size_t count = map.counts[map.index(row, column)];
      if (count == 0) {
        text += ' ';
      } else if (colored) {
        text += fmt::format("\033[48;5;{}m \033[0m", kColors[shade(count, largest)]);
      } else {
        text += kShades[shade(count, largest)];
      }
    }
    while (text.back() == ' ') text.pop_back();
    text += '\n';
  }
  return text;
}

namespace {

constexpr const char* kInfoFooter = R"(Examples:
  palpate info bunny.ply
  palpate info scan.las --picture trust.png
  palpate info room.spz --length 4.2 --write points.ply
  palpate info depth.png --intrinsics 525,525,319.5,239.5
  palpate info - < scan.pcd
  palpate info sequence:recording camera:openni2
  palpate info bunny.ply --tool box:20x30x10

docs/touch.md explains each line of the report.

Exit codes: 0 done, 1 the input is bad, 2 the command line is wrong.)";

constexpr std::size_t kShownPoints = 100'000;

// Draws where a cloud is trusted, by a script for Python with matplotlib that travels inside the
// program.
class TrustPicture {
 public:
  // @throws Error when the file cannot be made.
  explicit TrustPicture(const std::string& path) : path_(path), file_(path) {}

  // Keeps what the picture shows: what is felt inside `box` (m, world), thinned evenly.
  void take(const std::string& name, const Prepared& prepared, const Box& box);

  // @throws Error when Python or matplotlib is missing, naming the package, or drawing fails.
  void draw();

 private:
  std::string path_;
  OutputFile file_;
  std::vector<float> rows_;  // position from the box's middle, normal, trust
  std::string facts_;
};

void TrustPicture::take(const std::string& name, const Prepared& prepared, const Box& box) {
  const SurfacePoints& points = prepared.points;
  const std::size_t kept = std::min(points.size(), kShownPoints);
  for (std::size_t k = 0; k < kept; ++k) {
    const std::size_t i = k * points.size() / kept;
    const Eigen::Vector3d world = points.origin + points.grid.points()[i].cast<double>();
    if (points.density_weights[i] <= 0 || !box.contains(world)) continue;
    const Eigen::Vector3f p = (world - box.center()).cast<float>();
    const Eigen::Vector3f& n = points.normals[i];
    rows_.insert(rows_.end(), {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), points.confidences[i]});
  }
  const Eigen::Vector3d middle = box.center();
  const double share = 100 * prepared.report.untrusted;
  const std::string thinned =
      kept < points.size() ? fmt::format("; thinned to {} points", grouped(kept)) : "";
  const nlohmann::json facts = {
      {"title", fmt::format("{:.3g} % of {} has low trust", share, name)},
      {"subtitle", "rendered as a metaball where trust is below 0.5" + thinned},
      {"middle", {middle.x(), middle.y(), middle.z()}}};
  facts_ = facts.dump();
}

void TrustPicture::draw() {
  const Waiting waiting("drawing the picture");
  draw_by_python(trust_script(), {{"cloud.f32", float_bytes(rows_)}, {"facts.json", facts_}}, path_,
                 file_);
}

void print_map(const PointCloud& cloud, std::FILE* out) {
  constexpr int kColumns = 72;
  const Style style(out);
  const DensityMap map = map_density(cloud, kColumns);
  const std::size_t largest = *std::max_element(map.counts.begin(), map.counts.end());
  fmt::print(out,
             "{} {} to the right, {} up; each character is {} wide, the densest has {} points\n{}",
             style.heading("density"), "xyz"[map.horizontal], "xyz"[map.vertical], length(map.cell),
             grouped(largest), draw(map, style.colored()));
}

InfoReport measure_cloud(const CloudArgument& argument, const FileReading& options,
                         const std::string& write) {
  InfoReport report;
  report.loaded = load(argument, options);
  if (!write.empty()) write_cloud(write, report.loaded.file.cloud);
  const PointCloud& cloud = report.loaded.file.cloud;
  report.bounds = session::bounds_of(cloud);
  report.core = session::core_of(cloud);
  report.units = session::units_of(report.loaded.file, report.core);
  report.organised = depth_frame_of(cloud);
  if (report.organised.frame) {
    Source felt(argument.name, {});
    felt.set(cloud);
    report.image = felt.state();
    report.image_radius = felt.points()->radius;
  }
  return report;
}

void study(InfoReport& report, TrustPicture* picture) {
  const PointCloud& cloud = report.loaded.file.cloud;
  const std::string& name = report.loaded.argument.name;
  Progress progress("studying " + name);
  report.nearest_three = nearest_three(CellGrid(cloud.positions));
  const Prepared prepared = prepare(cloud, {.progress = progress.updater()});
  report.prepared = prepared.report;
  report.rim = rim_share(prepared.points);
  if (picture != nullptr) picture->take(name, prepared, report.core);
}

// Takes each scan of a file by itself, as touch does, unless there are too many.
std::vector<CloudArgument> clouds_of(const InfoOptions& options) {
  std::vector<CloudArgument> clouds;
  for (const CloudArgument& argument : parse_clouds(options.clouds)) {
    std::ranges::copy(split_scans(argument, Scene::kMaxSources), std::back_inserter(clouds));
  }
  return clouds;
}

void refuse_streams(const std::vector<CloudArgument>& clouds, std::string_view option,
                    const std::string& path) {
  for (const CloudArgument& cloud : clouds) {
    if (path.empty() || !lives(cloud.path)) continue;
    throw UsageError(fmt::format(
        "{} works only with clouds, and {} is a stream; remove one of them", option, cloud.path));
  }
}

// One a cloud, or none. Whether they can be made is tried before any work.
std::vector<TrustPicture> pictures_of(const std::vector<CloudArgument>& clouds,
                                      const InfoOptions& options) {
  std::vector<NamedFile> outputs = {{"--json", options.json}};
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    outputs.push_back({"--picture", numbered_path(options.picture, i)});
    outputs.push_back({"--write", numbered_path(options.write, i)});
  }
  check_distinct(inputs(clouds), outputs);
  refuse_streams(clouds, "--picture", options.picture);
  refuse_streams(clouds, "--write", options.write);
  if (options.picture.empty()) return {};
  check_picture(options.picture);
  std::vector<TrustPicture> pictures;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    pictures.emplace_back(numbered_path(options.picture, i));
  }
  return pictures;
}

}  // namespace

void add_info_options(CLI::App& command, InfoOptions& options) {
  command
      .add_option("clouds", options.clouds,
                  wrapped(cloud_help() + "; or a camera or sequence as for touch"))
      ->type_name("CLOUD");
  OptionTable table(command);
  add_reading_options(table, options.reading);
  table.under("Tool");
  add_tool_shape(table, options.tool);
  add_json_option(command, options.json)->group("Output");
  command
      .add_option("--picture", options.picture,
                  wrapped("map of the cloud's trust as PNG (needs python3-matplotlib); several "
                          "clouds give one file each: a.png, a-2.png"))
      ->type_name("FILE")
      ->group("Output");
  command
      .add_option("--write", options.write,
                  wrapped("the points with normals and colours as PLY or PCD, of splats those of "
                          "the shell; several clouds give one file each: a.ply, a-2.ply"))
      ->type_name("FILE")
      ->group("Output");
  command.footer(kInfoFooter);
}

void info(const InfoOptions& options) {
  const ToolPlan& tool = options.tool;
  require(tool.turns() || !options.clouds.empty(), "clouds is required, or a --tool");
  require(tool.turns() || !tool.spacing, "--tool-spacing is of a tool that turns; add --tool");
  require(!options.clouds.empty() || (options.picture.empty() && options.write.empty()),
          "--picture and --write need a cloud; name one");
  nlohmann::ordered_json clouds = nlohmann::ordered_json::array();
  const std::vector<CloudArgument> arguments = clouds_of(options);
  std::vector<TrustPicture> pictures = pictures_of(arguments, options);
  std::FILE* out = options.json == "-" ? stderr : stdout;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const CloudArgument& argument = arguments[i];
    if (lives(argument.path)) {
      Report report = report_of(study_live(argument));
      report.print(out);
      if (tool.turns()) report_tool(report, tool, 0, out);
      clouds.push_back(report.data);
      continue;
    }
    InfoReport info = measure_cloud(argument, options.reading, numbered_path(options.write, i));
    Report report = report_of(info);
    report.print(out);
    study(info, pictures.empty() ? nullptr : &pictures[i]);
    add_study(report, info);
    report.print(out);
    advice_of(info).print(out);
    if (tool.turns()) report_tool(report, tool, felt_radius(info), out);
    print_map(info.loaded.file.cloud, out);
    clouds.push_back(report.data);
  }
  if (arguments.empty()) {
    Report report("", "");
    report_tool(report, tool, 0, out);
    clouds.push_back(report.data);
  }
  write_whole(options.json, text_of(clouds));
  for (TrustPicture& picture : pictures) picture.draw();
}

}  // namespace palpate::app
