#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "apps/palpate/options/touch_options.hpp"
#include "apps/program.hpp"

namespace palpate::app {

/// Parses as the program does what follows "palpate touch".
inline TouchPlan planned(const std::string& arguments) {
  TouchChoices choices;
  CLI::App command;
  add_touch_command(command, choices);
  command.parse(arguments, false);
  return plan_touch(command, choices);
}

/// The same with a set-up file, which holds `toml`.
inline TouchPlan planned(const Shell& shell, const std::string& toml,
                         const std::string& arguments) {
  shell.write("desk.toml", toml);
  return planned(fmt::format("--setup {} {}", shell.path("desk.toml"), arguments));
}

}  // namespace palpate::app
