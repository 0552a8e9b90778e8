#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "apps/palpate/options/setup_file.hpp"
#include "apps/program.hpp"

namespace palpate::app {

/// As the program does with a command line after "palpate touch".
inline TouchOptions parsed(const Shell& shell, const std::string& toml,
                           const std::string& arguments) {
  shell.write("desk.toml", toml);
  TouchOptions options;
  CLI::App command;
  add_touch_options(command, options);
  command.parse(fmt::format("--setup {} {}", shell.path("desk.toml"), arguments), false);
  apply_setup(command, options);
  return options;
}

}  // namespace palpate::app
