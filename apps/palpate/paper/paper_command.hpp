#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate paper FIGURE`.
struct PaperOptions {
  std::string source;  ///< camera or sequence
  std::string csv;
  std::string picture;
  int repeats = 5;               ///< of each measurement of fig5; the fastest counts
  double duration = 4;           ///< of the press of fig7, s
  std::optional<double> radius;  ///< R of the paper's clouds in fig7, m
  std::optional<double> voxel;   ///< of the paper's clouds in fig7, m
};

/// The figures of `palpate paper`, each a command of its own.
struct PaperCommand {
  PaperOptions options;
  CLI::App* fig5 = nullptr;
  CLI::App* fig7 = nullptr;
};

void add_paper_options(CLI::App& command, PaperCommand& paper);

/// `palpate paper`. @throws UsageError, Error.
void paper(const PaperCommand& paper);

}  // namespace palpate::app
