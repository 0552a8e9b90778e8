// Table A of the evaluation: one raw depth frame with known truth, touched along known paths.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>

#include "accuracy/table.hpp"
#include "palpate/base/error.hpp"

namespace {

using namespace palpate::accuracy;

struct Arguments {
  BenchOptions bench;
  palpate::PrepareOptions prepare;
  std::vector<std::string> fields;
  std::string noise = "a";
  std::string csv_file;
};

void add_options(CLI::App& app, Arguments& arguments) {
  BenchOptions& bench = arguments.bench;
  app.add_option("--seeds", bench.seeds, "Frames")->check(CLI::Range(1, 1000));
  app.add_option("--first-seed", bench.first_seed, "Seed of the first frame");
  app.add_option("--layout", bench.layout, "Placement of the objects (0-2)");
  app.add_option("--noise", arguments.noise, "a independent, b blurred, c quantised")
      ->check(CLI::IsMember({"a", "b", "c"}));
  app.add_flag("--silhouettes", bench.silhouettes, "Missing and flying pixels at depth jumps");
  app.add_option("--rows", bench.rows, "Only rows whose names hold one of these")->delimiter(',');
  app.add_option("--field", arguments.fields, "Only columns whose names hold one of these")
      ->delimiter(',');
  app.add_option("--csv", arguments.csv_file, "Write every score to this file");
  app.add_option("--voxel", arguments.prepare.voxel, "Leaf of the voxel filter, m, not automatic");
  app.add_option("--radius", arguments.prepare.radius, "Support radius, m, not automatic");
  app.add_option("--normal-error", arguments.prepare.normal_error, "Wanted normal error, rad");
}

palpate::NoiseKind noise_of(const std::string& letter) {
  if (letter == "b") return palpate::NoiseKind::blurred;
  return letter == "c" ? palpate::NoiseKind::quantised : palpate::NoiseKind::independent;
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

void write_csv(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw palpate::Error("cannot write " + file + "; is its folder there?");
}

int run(const Arguments& arguments) {
  const std::vector<Contender> contenders = chosen(arguments);
  if (contenders.empty()) throw palpate::Error("no column matches --field; try balanced or paper");
  const BenchResults results = run_bench(arguments.bench, contenders);
  fmt::print("Noise {}, layout {}, {} frames from seed {}{}. Median (worst frame).\n\n",
             arguments.noise, arguments.bench.layout, arguments.bench.seeds,
             arguments.bench.first_seed, arguments.bench.silhouettes ? ", silhouettes" : "");
  fmt::print("{}\nThe first frame:\n\n{}", markdown_table(results, contenders, arguments.bench),
             markdown_preparation(results));
  if (!arguments.csv_file.empty()) {
    write_csv(arguments.csv_file, csv(results, arguments.bench));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Accuracy on depth frames with known truth");
  Arguments arguments;
  add_options(app, arguments);
  CLI11_PARSE(app, argc, argv);
  arguments.bench.noise = noise_of(arguments.noise);
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "accuracy_bench: {}\n", error.what());
    return 1;
  }
}
