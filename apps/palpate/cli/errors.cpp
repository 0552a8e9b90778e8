// Usage errors and suggestions for mistyped names.
#include "apps/palpate/cli/errors.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>

namespace palpate::app {

namespace {

// Letters to put in, take out, change or swap with their neighbour (Damerau and Levenshtein,
// "optimal string alignment"): three rows of its table are kept.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> older;
  std::vector<std::size_t> old(b.size() + 1);
  std::iota(old.begin(), old.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> row(b.size() + 1, i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = old[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({change, old[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], older[j - 2] + 1);
    }
    older = std::move(old);
    old = std::move(row);
  }
  return old.back();
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) names.push_back(option->get_name());
  return names;
}

std::vector<std::string> commands_of(const CLI::App& command) {
  std::vector<std::string> names;
  const auto all = [](const CLI::App*) { return true; };
  for (const CLI::App* each : command.get_subcommands(all)) names.push_back(each->get_name());
  return names;
}

// Words that belong together are often cut short: --friction is --friction-static.
std::string_view first_word(std::string_view option) {
  return option.substr(0, option.find('-', option.find_first_not_of('-')));
}

}  // namespace

std::string meant(std::string_view word, const std::vector<std::string>& names) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t away = std::min(distance(word, name), distance(word, first_word(name)));
    if (away >= least) continue;
    least = away;
    best = name;
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
  const std::string near = meant(word, names);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

std::string hint(const CLI::App& program) {
  for (const std::string& word : program.remaining()) {
    const bool option = word.starts_with("--");
    const std::string near = did_you_mean(option ? word.substr(0, word.find('=')) : word,
                                          option ? options_of(program) : commands_of(program));
    if (!near.empty()) return near;
  }
  const std::vector<std::string> commands = commands_of(program);
  const bool inner = program.get_parent() != nullptr && !commands.empty();
  if (inner && program.get_subcommands().empty() && !program.remaining().empty()) {
    return fmt::format("; put one of {} before it", fmt::join(commands, ", "));
  }
  for (const CLI::App* each : program.get_subcommands()) {
    if (const std::string found = hint(*each); !found.empty()) return found;
  }
  return "";
}

}  // namespace palpate::app
