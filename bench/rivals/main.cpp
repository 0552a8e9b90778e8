// Every method of the paper's section II on the drawn scenes of table A, side by side.
#include "common/main.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "accuracy/table.hpp"
#include "rivals/compare_table.hpp"
#include "rivals/edge_slide.hpp"
#include "rivals/modes.hpp"

namespace {

using namespace palpate::rivals;

struct Arguments {
  CompareOptions compare;
  std::vector<std::string> names;
  std::vector<std::string> noises = {"a", "b", "c"};
  std::string out;
  bool tune = false;
  bool times = false;
  bool streams = false;
  bool events = false;
  bool clouds = false;
  palpate::accuracy::RecordedOptions recording;
};

// What is played of a bench; one of them at a time.
void add_modes(CLI::App& app, Arguments& arguments) {
  auto* modes = app.add_option_group("Others' scenes instead of the drawn ones");
  modes->require_option(0, 1);
  modes->add_flag("--streams", arguments.streams, "Depth streams of streams_bench");
  modes->add_flag("--events", arguments.events, "Events of events_bench");
  modes->add_flag("--any-cloud", arguments.clouds, "Clouds of any_cloud_bench");
  auto& recording = arguments.recording;
  auto* folder =
      modes->add_option("--recording", recording.folder, "Flat parts of a real recording");
  app.add_option("--first-frame", recording.first, "Number of its first frame, from 0")
      ->needs(folder);
  app.add_option("--frames", recording.count, "Frames through which nothing moves")->needs(folder);
  app.add_option("--ways", recording.ways, "Straight ways through its free air")->needs(folder);
}

void add_options(CLI::App& app, Arguments& arguments) {
  auto& bench = arguments.compare.bench;
  bench.layouts = 8;
  bench.first_layout = 501;
  bench.seeds = 2;
  app.add_option("--methods", arguments.names, "Only these")->delimiter(',');
  app.add_option("--layouts", bench.layouts, "Drawn scenes")->check(CLI::Range(1, 100000));
  app.add_option("--first-layout", bench.first_layout, "Number (seed) of the first");
  app.add_option("--seeds", bench.seeds, "Frames of each, or runs of a row")
      ->check(CLI::Range(1, 1000));
  app.add_option("--first-seed", bench.first_seed, "Seed of the first of them");
  app.add_option("--only", bench.rows, "Only rows whose names hold one of these")->delimiter(',');
  app.add_option("--noise", arguments.noises, "a independent, b blurred, c quantised, none")
      ->delimiter(',')
      ->check(CLI::IsMember({"a", "b", "c", "none"}));
  app.add_option("--threads", arguments.compare.threads, "Scenes at a time")
      ->check(CLI::Range(1, 256));
  app.add_option("--out", arguments.out,
                 "Folder for scores.csv and edge.csv, which picture.py draws");
  app.add_flag("--times", arguments.times, "Computing times, too; they differ from run to run");
  app.add_flag("--tune", arguments.tune, "Each method's length at 1/2, 1 and 2 times what it is");
  add_modes(app, arguments);
}

// All by default; where there is one frame, the graph of a video is the graph.
std::vector<Method> chosen(const Arguments& arguments) {
  std::vector<Method> some;
  if (arguments.names.empty()) {
    some = methods();
    const bool one_frame = !arguments.streams && !arguments.events;
    std::erase_if(
        some, [&](const Method& m) { return one_frame && m.name == std::string_view("video"); });
  }
  for (const std::string& name : arguments.names) some.push_back(method_named(name));
  return some;
}

// Plays what another bench plays. @return false where none is named.
bool play_others(const Arguments& arguments, std::vector<Method> methods) {
  const auto& bench = arguments.compare.bench;
  const palpate::bench::SeedOptions seeds{bench.rows, bench.first_seed, bench.seeds};
  const bool recording = !arguments.recording.folder.empty();
  if (arguments.clouds) print_clouds(seeds, methods);
  if (recording) fmt::print("{}", markdown_recording(arguments.recording, methods));
  // In time palpate goes the ways that these benches have.
  std::erase_if(methods, [](const Method& m) { return *m.length == 0; });
  if (arguments.streams) fmt::print("{}", markdown_streams(seeds, methods));
  if (arguments.events) print_events(seeds, methods);
  return arguments.clouds || recording || arguments.streams || arguments.events;
}

// Mean force error by factors of the length, for those that have one.
int tune(Arguments& arguments) {
  constexpr std::array<double, 3> kFactors = {0.5, 1, 2};
  std::erase_if(arguments.compare.methods, [](const Method& m) { return *m.length == 0; });
  fmt::print("| method | 1/2, N | 1, N | 2, N |\n|---|---|---|---|\n");
  std::vector<std::array<double, 3>> errors(arguments.compare.methods.size());
  for (std::size_t k = 0; k < kFactors.size(); ++k) {
    CompareOptions options = arguments.compare;
    for (Method& method : options.methods) method.scale = kFactors[k];
    for (const std::string& noise : arguments.noises) {
      options.bench.noise = palpate::accuracy::noise_kind(noise);
      const Compared found = compare(options);
      for (std::size_t i = 0; i < errors.size(); ++i) {
        errors[i][k] += mean_force_error(found.scores, options.methods[i].name) /
                        static_cast<double>(arguments.noises.size());
      }
    }
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} |\n", arguments.compare.methods[i].name,
               errors[i][0], errors[i][1], errors[i][2]);
  }
  return 0;
}

void write_results(const Arguments& arguments, const std::string& scores) {
  std::filesystem::create_directories(arguments.out);
  palpate::bench::write_file(arguments.out + "/scores.csv", scores);
  palpate::bench::write_file(arguments.out + "/edge.csv", edge_slide_csv(arguments.compare));
}

int run(Arguments& arguments) {
  arguments.compare.methods = chosen(arguments);
  const std::vector<Method>& methods = arguments.compare.methods;
  if (arguments.tune) return tune(arguments);
  if (play_others(arguments, methods)) return 0;
  const bool ours = std::ranges::any_of(
      methods, [](const Method& m) { return std::string_view(m.name) == "ours"; });
  std::string scores = palpate::accuracy::csv_header();
  std::string times;
  fmt::print("{}\n", markdown_methods(methods));
  for (const std::string& noise : arguments.noises) {
    arguments.compare.bench.noise = palpate::accuracy::noise_kind(noise);
    const Compared found = compare(arguments.compare);
    fmt::print("## Noise {}\n\n{}", noise, markdown_scores(found.scores, methods));
    if (ours) {
      fmt::print("Another method is more than a tenth before ours in:\n\n{}\n",
                 markdown_behind(found.scores, methods));
    }
    std::fflush(stdout);
    scores += palpate::accuracy::csv(found.scores, arguments.compare.bench);
    if (times.empty()) times = markdown_times(found.times, methods);
  }
  if (arguments.times) fmt::print("## Computing times\n\n{}", times);
  if (!arguments.out.empty()) write_results(arguments, scores);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Published ways to feel depth images, side by side", "compare_bench");
  Arguments arguments;
  add_options(app, arguments);
  return palpate::bench::run_main(
      app, argc, argv, [&] { return run(arguments); }, 2);
}
