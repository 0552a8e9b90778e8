// Clouds of every kind that surfaces are hard to tell of: what is felt beside the exact truth.

#include "common/main.hpp"

#include <algorithm>

#include "any_cloud/ablation.hpp"
#include "any_cloud/file_row.hpp"
#include "any_cloud/rows.hpp"
#include "any_cloud/table.hpp"

namespace {

using namespace palpate::any_cloud;

struct Arguments {
  std::vector<std::string> families;
  std::string row;
  std::uint64_t first_seed = 1;
  int seeds = 3;
  std::string field = "balanced";
  std::string csv_file;
  std::vector<std::string> files;
  int ways = 10000;
  int roam = 0;
  bool ablate = false;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("--family", arguments.families, "Only this family; may be repeated");
  app.add_option("--row", arguments.row, "Only rows whose names hold this");
  app.add_option("--first-seed", arguments.first_seed, "Seed of the first scene of a row");
  app.add_option("--seeds", arguments.seeds, "Scenes a row")->check(CLI::Range(1, 10000));
  app.add_option("--field", arguments.field, "What the points are made into")
      ->check(CLI::IsMember({"balanced", "pointset", "metaball"}));
  app.add_option("--file", arguments.files, "Only this cloud, without a truth; may be repeated");
  app.add_option("--ways", arguments.ways, "Straight ways through free air of a file's cloud")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--roam", arguments.roam,
                 "Ticks of a hand that roams around a closed body and in it, in place of pokes")
      ->check(CLI::Range(0, 10000000));
  app.add_flag("--ablate", arguments.ablate,
               "What each scene loses without each refinement of preparation, in turn");
  app.add_option("--csv", arguments.csv_file, "Write every score to this file");
}

palpate::FieldOptions field_options(const std::string& name) {
  palpate::FieldOptions options;
  if (name == "pointset") options.kind = palpate::FieldOptions::Kind::pointset;
  if (name == "metaball") options.kind = palpate::FieldOptions::Kind::metaball;
  return options;
}

std::vector<Row> wanted_rows(const Arguments& arguments) {
  std::vector<Row> rows;
  for (const std::string& file : arguments.files) rows.push_back(file_row(file, arguments.ways));
  if (!rows.empty()) return rows;
  rows = all_rows();
  std::erase_if(rows, [&](const Row& row) {
    const auto& families = arguments.families;
    const bool other = !families.empty() &&
                       std::find(families.begin(), families.end(), row.family) == families.end();
    return other || row.name.find(arguments.row) == std::string::npos;
  });
  for (Row& row : rows) {
    row.draw = [draw = std::move(row.draw), roam = arguments.roam](Draft& draft) {
      draft.roam = roam;
      draw(draft);
    };
  }
  return rows;
}

int print_prices(const std::vector<Row>& rows, const Arguments& arguments) {
  int scenes = 0;
  const auto prices =
      ablate(rows, arguments.first_seed, arguments.seeds, field_options(arguments.field), [&] {
        if (++scenes % 50 == 0) fmt::print(stderr, "{} scenes\n", scenes);
      });
  fmt::print("Field {}, {} seeds from {}.\n{}", arguments.field, arguments.seeds,
             arguments.first_seed, price_table(prices));
  return 0;
}

int run(const Arguments& arguments) {
  const std::vector<Row> rows = wanted_rows(arguments);
  if (rows.empty())
    throw palpate::Error("no row matches --family and --row; leave them out to see all");
  if (arguments.ablate) return print_prices(rows, arguments);
  std::vector<Result> all;
  fmt::print("Field {}, {} seeds from {}.\n{}\n{}", arguments.field, arguments.seeds,
             arguments.first_seed, legend(), header());
  for (const Row& row : rows) {
    std::vector<Result> results;
    for (int i = 0; i < arguments.seeds; ++i) {
      results.push_back(run_row(row, arguments.first_seed + static_cast<std::uint64_t>(i),
                                field_options(arguments.field)));
    }
    fmt::print("{}", table_line(results));
    std::fflush(stdout);
    all.insert(all.end(), results.begin(), results.end());
  }
  if (arguments.csv_file.empty()) return 0;
  palpate::bench::write_file(arguments.csv_file, csv(all));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What is felt of clouds that surfaces are hard to tell of, beside the truth",
               "any_cloud_bench");
  Arguments arguments;
  add_options(app, arguments);
  return palpate::bench::run_main(app, argc, argv, [&] { return run(arguments); });
}
