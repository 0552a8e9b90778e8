#include "apps/palpate/info_command.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/palpate/distinct_files.hpp"
#include "apps/palpate/info_report.hpp"
#include "apps/palpate/live_facts.hpp"
#include "apps/palpate/load.hpp"
#include "apps/palpate/option_checks.hpp"
#include "apps/palpate/output.hpp"
#include "apps/palpate/waiting.hpp"

namespace palpate::app {

namespace {

constexpr const char* kInfoFooter = R"(Examples:
  palpate info bunny.ply
  palpate info depth.png --intrinsics 525,525,319.5,239.5
  palpate info - < scan.pcd
  palpate info sequence:recording camera:openni2

Exit codes: 0 done, 1 the input is at fault, 2 the command line is wrong.)";

InfoReport study(const CloudArgument& argument, const ReadingOptions& options) {
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
  return report;
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
  command.footer(kInfoFooter);
}

void info(const InfoOptions& options) {
  if (!options.reading.intrinsics.empty()) (void)parse_intrinsics(options.reading.intrinsics);
  nlohmann::ordered_json clouds = nlohmann::ordered_json::array();
  const std::vector<CloudArgument> arguments = parse_clouds(options.clouds);
  check_distinct(inputs(arguments), {{"--json", options.json}});
  std::FILE* out = options.json == "-" ? stderr : stdout;
  for (const CloudArgument& argument : arguments) {
    if (lives(argument.path)) {
      const LiveFacts facts = study_live(argument);
      print_facts(facts, out);
      clouds.push_back(json_facts(facts));
      continue;
    }
    const InfoReport report = study(argument, options.reading);
    print_report(report, out);
    clouds.push_back(json_report(report));
  }
  if (options.json.empty()) return;
  OutputFile file(options.json);
  file.write(clouds.dump(2));
  file.write("\n");
  file.close();
}

}  // namespace palpate::app
