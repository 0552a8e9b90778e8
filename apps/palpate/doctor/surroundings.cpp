#include "apps/palpate/doctor/surroundings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/palpate/plot/python_drawing.hpp"

namespace palpate::app::doctor {

namespace {

constexpr const char* kSurroundings = "surroundings";
// A cloud of 640 x 480 points of 16 bytes, which comes in one burst.
constexpr long kLargeCloud = 640L * 480 * 16;
constexpr const char* kLargestBuffer = "2147483647";  // what ROS 2's guide to DDS tells

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

}  // namespace

Finding check_locales(const System& system) {
  Finding finding{kSurroundings, "locale"};
  for (const auto& [name, value] : system.variables) {
    if (name != "LANG" && !name.starts_with("LC_")) continue;
    if (value.empty() || system.decimal_point(value)) continue;
    finding.severity = Severity::warning;
    finding.words = fmt::format(
        "{}={}, which does not exist here: vendors' tools may not start or read files wrongly",
        name, value);
    finding.remedy = locale_command(name, value);
    return finding;
  }
  finding.words = "exists";
  return finding;
}

Finding check_decimal_point(const System& system) {
  const auto [name, locale] = numbers_locale(system);
  const std::string point = system.decimal_point(locale).value_or(".");
  Finding finding{kSurroundings, "decimal point"};
  finding.words = "numbers are written 0.5";
  if (point == ".") return finding;
  finding.severity = Severity::note;
  finding.words = fmt::format(
      "{}={} writes 0{}5: palpate reads and writes 0.5 everywhere, vendors' tools may not", name,
      locale, point);
  finding.remedy = fmt::format("export {}=C.UTF-8", name == "LC_ALL" ? "LC_ALL" : "LC_NUMERIC");
  return finding;
}

Finding check_network_buffer(const System& system) {
  Finding finding{kSurroundings, "network buffer"};
  const auto bytes = whole_number(system, "proc/sys/net/core/rmem_max");
  if (!bytes) {
    finding.words = "not told here (net.core.rmem_max)";
    return finding;
  }
  finding.words = fmt::format("net.core.rmem_max is {:.1f} MB", 1e-6 * static_cast<double>(*bytes));
  if (*bytes >= kLargeCloud) return finding;
  finding.severity = Severity::note;
  finding.words +=
      fmt::format("; a cloud of 640 x 480 points over DDS (ROS 2) has {:.1f} MB and may be lost",
                  1e-6 * kLargeCloud);
  finding.remedy = fmt::format(
      "echo net.core.rmem_max={} | sudo tee /etc/sysctl.d/60-palpate.conf && sudo sysctl --system",
      kLargestBuffer);
  return finding;
}

Finding check_runtime_folder(const System& system) {
  Finding finding{kSurroundings, "XDG_RUNTIME_DIR"};
  const std::string folder = variable(system, "XDG_RUNTIME_DIR");
  if (folder.empty()) {
    finding.severity = Severity::note;
    finding.words = "not set: the remote device has no place for its socket unless given one";
    finding.remedy = "export XDG_RUNTIME_DIR=$(mktemp -d)";
    return finding;
  }
  const Node node = system.node(system.root / std::filesystem::path(folder).relative_path());
  if (node.may_open) {
    finding.words = folder;
    return finding;
  }
  finding.severity = Severity::warning;
  finding.words = fmt::format(
      "{}, where this user may not write: the remote device's socket has no "
      "place there",
      folder);
  finding.remedy = "export XDG_RUNTIME_DIR=$(mktemp -d)";
  return finding;
}

Finding check_matplotlib(const System& system) {
  Finding finding{kSurroundings, "pictures"};
  finding.words = "Python 3 with matplotlib";
  if (system.succeeds(drawing_trial())) return finding;
  finding.severity = Severity::note;
  finding.words = "no Python 3 with matplotlib: --picture draws nothing";
  finding.remedy = "sudo apt install python3-matplotlib";
  return finding;
}

Finding check_browser(const System& system) {
  Finding finding{kSurroundings, "browser"};
  if (variable(system, "DISPLAY").empty() && variable(system, "WAYLAND_DISPLAY").empty()) {
    finding.severity = Severity::note;
    finding.words = "no desktop here: open the page from another machine, through ssh";
    finding.remedy = "ssh -L 8420:127.0.0.1:8420 HOST";
    return finding;
  }
  finding.words = "opens by itself for the page";
  if (any_program(system, kBrowsers) && is_there(system, "usr/bin/xdg-open")) return finding;
  finding.severity = Severity::note;
  finding.words = "no browser, or no xdg-open that starts it: the page does not open by itself";
  finding.remedy =
      fmt::format("sudo apt install xdg-utils {}", is_ubuntu(system) ? "firefox" : "firefox-esr");
  return finding;
}

Finding check_installation(const System& system) {
  Finding finding{kSurroundings, "palpate's files"};
  finding.words = system.share.string();
  const auto is_missing = [&](const char* name) {
    std::error_code ignored;
    return !std::filesystem::exists(system.share / name, ignored);
  };
  if (!is_missing("60-palpate.rules") && !is_missing("palpate-limits.conf")) return finding;
  finding.severity = Severity::warning;
  finding.words += " lacks 60-palpate.rules or palpate-limits.conf, which commands told here copy";
  finding.remedy = "sudo cmake --install build/release";
  return finding;
}

}  // namespace palpate::app::doctor
