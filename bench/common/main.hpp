#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "common/wanted.hpp"
#include "palpate/base/error.hpp"

/// The common part of benches' main programs: options, errors and files.
namespace palpate::bench {

/// Which rows are played, and with which seeds.
struct SeedOptions {
  std::vector<std::string> names;  ///< only rows whose names hold one of these; empty: all
  std::uint64_t first_seed = 1;
  int seeds = 5;
  bool each = false;  ///< a line for each seed, too
};

inline void add_options(CLI::App& app, SeedOptions& options) {
  app.add_option("--only", options.names, "Rows whose names hold one of these");
  app.add_option("--seeds", options.seeds, "Runs of a row")->check(CLI::Range(1, 10000));
  app.add_option("--first-seed", options.first_seed, "Seed of the first run");
  app.add_flag("--each", options.each, "A line for each seed, too");
}

/// @throws Error when the file cannot be written.
inline void write_file(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw Error("cannot write " + file + "; is its folder there?");
}

/// Reads the arguments and calls `run`, which returns the exit status; an exception is told on
/// stderr after the program's name, and `failure` returned.
template <class Run>
int run_main(CLI::App& app, int argc, char** argv, const Run& run, int failure = 1) {
  CLI11_PARSE(app, argc, argv);
  try {
    return run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", app.get_name(), error.what());
    return failure;
  }
}

}  // namespace palpate::bench
