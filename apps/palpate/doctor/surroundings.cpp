// Checks the programs and the locale around palpate: Python, browsers, number formats.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/palpate/doctor/checks.hpp"
#include "apps/palpate/plot/python_drawing.hpp"

namespace palpate::app::doctor {

namespace {

constexpr const char* kSurroundings = "surroundings";
constexpr std::array kBrowsers = {"firefox",  "firefox-esr",   "chromium",     "chromium-browser",
                                  "epiphany", "google-chrome", "x-www-browser"};

bool any_program(const System& system, const auto& names) {
  return std::ranges::any_of(names, [&](const std::string& name) {
    return is_there(system, "usr/bin/" + name) || is_there(system, "snap/bin/" + name);
  });
}

// The command that makes a locale, or one that does without where the name is odd.
std::string locale_command(const std::string& variable_name, const std::string& locale) {
  const bool plain = locale.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.@-") ==
                     std::string::npos;
  const std::size_t dot = locale.find('.');
  if (!plain || locale.find('_') == std::string::npos || dot == std::string::npos) {
    return fmt::format("export {}=C.UTF-8", variable_name);
  }
  const std::size_t at = std::min(locale.find('@'), locale.size());
  return fmt::format("sudo apt install locales && sudo localedef -i {}{} -f {} {}",
                     locale.substr(0, dot), locale.substr(at), locale.substr(dot + 1, at - dot - 1),
                     locale);
}

// The one that decides on numbers: its variable and its value.
std::pair<std::string, std::string> numbers_locale(const System& system) {
  for (const char* name : {"LC_ALL", "LC_NUMERIC", "LANG"}) {
    const std::string value = variable(system, name);
    if (!value.empty()) return {name, value};
  }
  return {"LANG", "C"};
}

Answer locale(const Machine& machine) {
  for (const auto& [name, value] : machine.system.variables) {
    if (name != "LANG" && !name.starts_with("LC_")) continue;
    if (value.empty() || machine.system.decimal_point(value)) continue;
    return warning(
        fmt::format(
            "{}={}, which is not installed: vendor tools may not start or may misread files", name,
            value),
        locale_command(name, value));
  }
  return good("exists");
}

Answer decimal_point(const Machine& machine) {
  const auto [name, locale] = numbers_locale(machine.system);
  const std::string point = machine.system.decimal_point(locale).value_or(".");
  if (point == ".") return good("numbers are written as 0.5");
  return note(
      fmt::format("{}={} writes 0{}5: palpate always reads and writes 0.5, vendor tools may not",
                  name, locale, point),
      fmt::format("export {}=C.UTF-8", name == "LC_ALL" ? "LC_ALL" : "LC_NUMERIC"));
}

Answer runtime_folder(const Machine& machine) {
  static constexpr const char* kRemedy = "export XDG_RUNTIME_DIR=$(mktemp -d)";
  const std::string folder = variable(machine.system, "XDG_RUNTIME_DIR");
  if (folder.empty()) {
    return note("not set: remote devices and cameras have no default socket path", kRemedy);
  }
  const auto path = machine.system.root / std::filesystem::path(folder).relative_path();
  if (machine.system.node(path).may_open) return good(folder);
  return warning(
      folder + " is not writable: remote devices and cameras cannot create their sockets there",
      kRemedy);
}

Answer pictures(const Machine& machine) {
  if (machine.system.succeeds(drawing_trial())) return good("Python 3 with matplotlib");
  return note("no Python 3 with matplotlib: --picture does not work",
              "sudo apt install python3-matplotlib");
}

Answer browser(const Machine& machine) {
  const System& system = machine.system;
  if (variable(system, "DISPLAY").empty() && variable(system, "WAYLAND_DISPLAY").empty()) {
    return note("no desktop: open the page from another machine over ssh",
                "ssh -L 8420:127.0.0.1:8420 HOST");
  }
  if (any_program(system, kBrowsers) && is_there(system, "usr/bin/xdg-open")) {
    return good("opens the page automatically");
  }
  return note(
      "no browser or no xdg-open to start it: the page does not open automatically",
      fmt::format("sudo apt install xdg-utils {}", is_ubuntu(system) ? "firefox" : "firefox-esr"));
}

// The files that other answers' commands copy, unless a package has installed them.
Answer installation(const Machine& machine) {
  if (has_rules(machine.system) && is_there(machine.system, kLimits)) {
    return good("udev and logins read palpate's rules and limits");
  }
  const std::string share = machine.system.share.string();
  for (const char* name : {"60-palpate.rules", "palpate-limits.conf"}) {
    std::error_code ignored;
    if (std::filesystem::exists(machine.system.share / name, ignored)) continue;
    return warning(share +
                       " lacks 60-palpate.rules or palpate-limits.conf, which other commands in "
                       "this list copy",
                   "sudo cmake --install build/release");
  }
  return good(share);
}

constexpr std::array kChecks = {
    Check{kSurroundings, "palpate's files", installation},
    Check{kSurroundings, "XDG_RUNTIME_DIR", runtime_folder},
    Check{kSurroundings, "locale", locale},
    Check{kSurroundings, "decimal point", decimal_point},
    Check{kSurroundings, "pictures", pictures},
    Check{kSurroundings, "browser", browser},
};

}  // namespace

void check_surroundings(const Machine& machine, Findings& findings) {
  run_checks(kChecks, machine, findings);
}

}  // namespace palpate::app::doctor
