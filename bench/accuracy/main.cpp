// Table A of the evaluation: raw depth frames with known truth, touched along known paths.

#include "common/main.hpp"

#include <algorithm>

#include "accuracy/drawn_table.hpp"
#include "accuracy/flat.hpp"
#include "accuracy/recorded.hpp"
#include "accuracy/sweep.hpp"

namespace {

using namespace palpate::accuracy;

struct Arguments {
  BenchOptions bench;
  RecordedOptions recorded;
  palpate::PrepareOptions prepare;
  std::vector<std::string> fields;
  std::vector<std::string> noises = {"a"};
  bool sweep = false;
  bool flat = false;
  std::string csv_file;
};

void add_recording_options(CLI::App& app, RecordedOptions& recorded,
                           const std::vector<CLI::Option*>& others) {
  auto* recording =
      app.add_option("--recording", recorded.folder, "Flat parts of a real recording instead");
  for (CLI::Option* other : others) recording->excludes(other);
  app.add_option("--first-frame", recorded.first, "Number of its first frame, from 0")
      ->needs(recording);
  app.add_option("--frames", recorded.count, "Frames through which nothing moves")
      ->needs(recording)
      ->check(CLI::Range(1, 1000));
  app.add_option("--ways", recorded.ways, "Straight ways through its free air")->needs(recording);
}

void add_noise_options(CLI::App& app, Arguments& arguments) {
  BenchOptions& bench = arguments.bench;
  app.add_option("--noise", arguments.noises, "a independent, b blurred, c quantised, none")
      ->delimiter(',')
      ->check(CLI::IsMember({"a", "b", "c", "none"}));
  app.add_option("--correlation", bench.correlation, "Of the noise, pixels, not by its letter")
      ->check(CLI::Range(0.0, 30.0));
  app.add_option("--sigma", bench.sigma, "Deviation of the noise at all depths, m");
  app.add_option("--terraces", bench.terraces, "Steps of depth, m");
  app.add_option("--uneven", bench.uneven, "Times the error where flat things are touched (--flat)")
      ->check(CLI::Range(1.0, 10.0));
  app.add_flag("--fine", bench.fine, "Pixels are 1280 x 720 (--flat, --sweep)");
  app.add_option("--rounding", bench.rounding, "Depths are whole multiples of it, m; 0: any");
  app.add_flag("--silhouettes", bench.silhouettes, "Missing and flying pixels at depth jumps");
}

void add_options(CLI::App& app, Arguments& arguments) {
  BenchOptions& bench = arguments.bench;
  app.add_option("--seeds", bench.seeds, "Frames")->check(CLI::Range(1, 1000));
  app.add_option("--first-seed", bench.first_seed, "Seed of the first frame");
  auto* fixed = app.add_option("--layout", bench.layout, "Placement of the objects (0-2)");
  auto* drawn =
      app.add_option("--layouts", bench.layouts, "So many drawn scenes with drawn paths instead")
          ->check(CLI::Range(1, 100000))
          ->excludes(fixed);
  app.add_option("--first-layout", bench.first_layout, "Number (seed) of the first drawn scene");
  app.add_flag("--sweep", arguments.sweep, "A plane and a sphere alone, by distance and incidence")
      ->excludes(fixed)
      ->excludes(drawn);
  app.add_flag("--flat", arguments.flat, "Planes alone, by distance and incidence")
      ->excludes(fixed)
      ->excludes(drawn);
  add_recording_options(app, arguments.recorded, {fixed, drawn});
  add_noise_options(app, arguments);
  app.add_option("--rows", bench.rows, "Only rows whose names hold one of these")->delimiter(',');
  app.add_option("--field", arguments.fields, "Only columns whose names hold one of these")
      ->delimiter(',');
  app.add_option("--csv", arguments.csv_file, "Write every score to this file");
  app.add_option("--voxel", arguments.prepare.voxel, "Leaf of the voxel filter, m, not automatic");
  app.add_option("--radius", arguments.prepare.radius, "Support radius, m, not automatic");
  app.add_option("--normal-error", arguments.prepare.normal_error, "Wanted normal error, rad");
}

std::vector<Contender> chosen(const Arguments& arguments) {
  std::vector<Contender> all = all_contenders(arguments.prepare);
  if (arguments.fields.empty()) return all;
  std::erase_if(all, [&](const Contender& contender) {
    return std::none_of(arguments.fields.begin(), arguments.fields.end(), [&](const auto& part) {
      return contender.name.find(part) != std::string::npos;
    });
  });
  return all;
}

std::string heading(const Arguments& arguments, const std::string& noise) {
  const BenchOptions& bench = arguments.bench;
  std::string frames = fmt::format("layout {}, {} frames", bench.layout, bench.seeds);
  if (arguments.sweep || arguments.flat) frames = fmt::format("{} frames a bin", bench.seeds);
  if (bench.layouts > 0) {
    frames = fmt::format("drawn layouts {} to {}, {} frames of each", bench.first_layout,
                         bench.first_layout + static_cast<std::uint64_t>(bench.layouts) - 1,
                         bench.seeds);
  }
  return fmt::format("Noise {}, {} from seed {}{}. Median (worst frame).\n\n", noise, frames,
                     bench.first_seed, bench.silhouettes ? ", silhouettes" : "");
}

std::string report(const Arguments& arguments, const BenchResults& results,
                   const std::vector<Contender>& contenders) {
  const BenchOptions& bench = arguments.bench;
  if (arguments.sweep || arguments.flat) {
    const auto markdown = arguments.sweep ? markdown_sweep : markdown_flat;
    std::string text;
    for (const Contender& contender : contenders) text += markdown(results, contender.name) + "\n";
    return text;
  }
  if (bench.layouts > 0) return markdown_drawn(results, contenders, bench.noise) + "\n";
  return fmt::format("{}\nThe first frame:\n\n{}", markdown_table(results, contenders, bench),
                     markdown_preparation(results));
}

int run(Arguments& arguments) {
  const std::vector<Contender> contenders = chosen(arguments);
  if (contenders.empty()) throw palpate::Error("no column matches --field; try balanced or paper");
  if (!arguments.recorded.folder.empty()) {
    arguments.recorded.seed = arguments.bench.first_seed;
    std::vector<Feeler> feelers;
    for (const Contender& contender : contenders) feelers.push_back(feeler_of(contender));
    fmt::print("{}", recorded_report(arguments.recorded, feelers));
    return 0;
  }
  std::string scores = csv_header();
  for (const std::string& noise : arguments.noises) {
    arguments.bench.noise = noise_kind(noise);
    const auto play = arguments.sweep ? run_sweep : arguments.flat ? run_flat : run_bench;
    const BenchResults results = play(arguments.bench, contenders);
    fmt::print("{}{}", heading(arguments, noise), report(arguments, results, contenders));
    scores += csv(results, arguments.bench);
  }
  if (!arguments.csv_file.empty()) palpate::bench::write_file(arguments.csv_file, scores);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Accuracy on depth frames with known truth", "accuracy_bench");
  Arguments arguments;
  add_options(app, arguments);
  return palpate::bench::run_main(app, argc, argv, [&] { return run(arguments); });
}
