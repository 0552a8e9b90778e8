#include "apps/palpate/info/info_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/info/info_report.hpp"
#include "apps/palpate/info/live_facts.hpp"
#include "apps/palpate/info/trust_picture.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

namespace {

constexpr const char* kInfoFooter = R"(Examples:
  palpate info bunny.ply
  palpate info scan.las --picture trust.png
  palpate info depth.png --intrinsics 525,525,319.5,239.5
  palpate info - < scan.pcd
  palpate info sequence:recording camera:openni2

docs/touch.md says what each line of the report means.

Exit codes: 0 done, 1 the input is at fault, 2 the command line is wrong.)";

InfoReport study(const CloudArgument& argument, const ReadingOptions& options,
                 TrustPicture* picture) {
  InfoReport report;
  report.loaded = load(argument, options);
  const PointCloud& cloud = report.loaded.file.cloud;
  const Waiting waiting("studying " + argument.name);
  report.bounds = bounds_of(cloud);
  report.core = core_of(cloud);
  report.units = guess_units(report.core, report.loaded.file.format);
  report.spacing = measure_spacing(CellGrid(cloud.positions));
  const Prepared prepared = prepare(cloud);
  report.prepared = prepared.report;
  report.rim = rim_share(prepared.points);
  report.organised = depth_frame_of(cloud);
  if (report.organised.frame) {
    Source felt(argument.name, {});
    felt.set(cloud);
    report.image = felt.state();
    report.image_radius = felt.points()->radius;
  }
  if (picture != nullptr) picture->take(argument.name, prepared, report.core);
  return report;
}

// One a cloud, or none. Whether they can be made is tried before any work.
std::vector<TrustPicture> pictures_of(const std::vector<CloudArgument>& clouds,
                                      const InfoOptions& options) {
  std::vector<NamedFile> outputs = {{"--json", options.json}};
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    outputs.push_back({"--picture", numbered_path(options.picture, i)});
  }
  check_distinct(inputs(clouds), outputs);
  check_picture(options.picture);
  std::vector<TrustPicture> pictures;
  if (options.picture.empty()) return pictures;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    if (lives(clouds[i].path)) {
      throw UsageError(fmt::format("--picture is of clouds, and {} is none; leave one of them out",
                                   clouds[i].path));
    }
    pictures.emplace_back(outputs[i + 1].path);
  }
  return pictures;
}

}  // namespace

void add_info_options(CLI::App& command, InfoOptions& options) {
  command
      .add_option("clouds", options.clouds,
                  wrapped(cloud_help() + "; or a camera or sequence as for touch"))
      ->required()
      ->type_name("CLOUD");
  add_reading_options(command, options.reading);
  add_json_option(command, options.json)->group("Output");
  command
      .add_option("--picture", options.picture,
                  wrapped("where the cloud is trusted, as PNG (needs python3-matplotlib); of "
                          "several clouds a file each: a.png, a-2.png"))
      ->type_name("FILE")
      ->group("Output");
  command.footer(kInfoFooter);
}

void info(const InfoOptions& options) {
  if (!options.reading.intrinsics.empty()) (void)parse_intrinsics(options.reading.intrinsics);
  nlohmann::ordered_json clouds = nlohmann::ordered_json::array();
  const std::vector<CloudArgument> arguments = parse_clouds(options.clouds);
  std::vector<TrustPicture> pictures = pictures_of(arguments, options);
  std::FILE* out = options.json == "-" ? stderr : stdout;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const CloudArgument& argument = arguments[i];
    if (lives(argument.path)) {
      const LiveFacts facts = study_live(argument);
      print_facts(facts, out);
      clouds.push_back(json_facts(facts));
      continue;
    }
    const InfoReport report =
        study(argument, options.reading, pictures.empty() ? nullptr : &pictures[i]);
    print_report(report, out);
    clouds.push_back(json_report(report));
  }
  if (!options.json.empty()) {
    OutputFile file(options.json);
    file.write(clouds.dump(2));
    file.write("\n");
    file.close();
  }
  for (TrustPicture& picture : pictures) picture.draw();
}

}  // namespace palpate::app
