// Picks the command and turns errors into messages and exit codes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/align/align_command.hpp"
#include "apps/palpate/bag/bag_command.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/manual.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/cli/version.hpp"
#include "apps/palpate/devices/devices_command.hpp"
#include "apps/palpate/doctor/checks.hpp"
#include "apps/palpate/info/info_command.hpp"
#include "apps/palpate/paper/paper_command.hpp"
#include "apps/palpate/replay/replay_command.hpp"
#include "apps/palpate/tile/tile_command.hpp"
#include "apps/palpate/touch/touch.hpp"
#include "apps/palpate/zwidth/zwidth_command.hpp"

namespace palpate::app {
namespace {

constexpr const char* kAbout =
    "palpate lets you feel a point cloud through a haptic device: it builds an implicit surface "
    "from the points and computes the force on the hand at 1 kHz.";

int complain(const std::string& what, int code) {
  fmt::print(stderr, "{} {}\n", Style(stderr).error("palpate:"), without_controls(what));
  return code;
}

// `code`, unless what was printed did not all get where it was to go.
int printed(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return complain(fmt::format("standard output: {}", std::strerror(errno)),
                  code != kSuccess ? code : kFailure);
}

struct Command {
  CLI::App* app;
  std::function<int()> run;
};

// Adds a command; its options live as long as it.
template <class Options>
Command command(CLI::App& program, const char* name, const char* help,
                void (*add)(CLI::App&, Options&),
                const std::function<int(const CLI::App&, const Options&)>& run) {
  CLI::App* const app = program.add_subcommand(name, help);
  const auto options = std::make_shared<Options>();
  add(*app, *options);
  return {app, [=] { return run(*app, *options); }};
}

// A command that succeeds unless it throws.
template <class Options>
Command command(CLI::App& program, const char* name, const char* help,
                void (*add)(CLI::App&, Options&), void (*run)(const Options&)) {
  return command<Options>(program, name, help, add, [run](const CLI::App&, const Options& options) {
    run(options);
    return kSuccess;
  });
}

// The same of one that reads which options it was given.
template <class Options>
Command command(CLI::App& program, const char* name, const char* help,
                void (*add)(CLI::App&, Options&), void (*run)(const CLI::App&, const Options&)) {
  return command<Options>(program, name, help, add,
                          [run](const CLI::App& app, const Options& options) {
                            run(app, options);
                            return kSuccess;
                          });
}

void touch_as_given(const CLI::App& app, const TouchChoices& choices) {
  touch(plan_touch(app, choices));
}

std::vector<Command> add_commands(CLI::App& p) {
  return {
      command(p, "touch", "Touch clouds and camera streams, and report the forces",
              add_touch_command, touch_as_given),
      command(p, "align", "Find the poses of cameras and clouds by aligning their surfaces",
              add_align_options, align_sources),
      command(p, "info", "Describe clouds, cameras and sequences", add_info_options, info),
      command(p, "tile", "Write clouds too large for memory as a store that is read in parts",
              add_tile_options, tile),
      command(p, "bag", "Describe recordings, and recover what can be read of damaged ones",
              add_bag_options, bag),
      command<ReplayCommand>(
          p, "replay", "Do a recorded run again and compare the forces, or view it",
          add_replay_options, [](const CLI::App&, const auto& options) { return replay(options); }),
      command(p, "cameras", "List cameras, and what is missing to use others", add_cameras_options,
              cameras),
      command<DoctorOptions>(p, "doctor",
                             "Check this machine for problems with devices and real-time operation",
                             add_doctor_options,
                             [](const CLI::App&, const auto& options) { return examine(options); }),
      command(p, "devices", "List haptic devices, and what is missing to use others",
              add_devices_options, devices),
      command(p, "ros", "List topics of ROS 2 that can be touched, held or driven", add_ros_options,
              ros),
      command(p, "paper", "Reproduce the experiments of Leeper, Chan and Salisbury 2012",
              add_paper_options, paper),
      command(p, "demo", "Touch a simulated scene in the browser with a mouse", add_demo_options,
              demo),
      command(p, "zwidth", "Map the stiffness that a device can render, compared with theory",
              add_zwidth_options, zwidth),
  };
}

// What the build installs beside the program, and no help mentions; empty: `argument` is no such
// thing.
std::string text_for_packages(CLI::App& program, std::string_view argument) {
  if (argument == "--print-manual") return manual_page(program);
  if (argument == "--print-completion") return bash_completion(program);
  return "";
}

// The arguments in the order of CLI11, last one first. Accepts 'version' and 'help touch', too.
std::vector<std::string> arguments(const CLI::App& program, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front() == "version") words.front() = "--version";
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    const auto named = [&](const CLI::App* each) { return each->get_name() == words.front(); };
    const bool valid = words.empty() || !program.get_subcommands(named).empty();
    if (valid) words.emplace_back("--help");  // else it is refused as what it is
  }
  std::ranges::reverse(words);
  return words;
}

// CLI11 names what it did not expect in reverse, and has own words for what is given twice.
std::string reason(const CLI::ParseError& error, const CLI::App& program) {
  constexpr std::string_view kTwice = ": At Most 1 required but received ";
  const std::string words = error.what();
  if (const std::size_t end = words.find(kTwice); end != std::string::npos) {
    return fmt::format("{} is given {} times; give it once", words.substr(0, end),
                       words.substr(end + kTwice.size()));
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return words;
  return fmt::format("not expected: {}", fmt::join(program.remaining(true), " "));
}

int run(int argc, char** argv) {
  CLI::App program(kAbout, "palpate");
  program.set_version_flag("-V,--version",
                           fmt::format("palpate {}\n{}", version(), build_details()));
  program.require_subcommand(0, 1);
  program.get_formatter()->column_width(34);
  program.footer(
      "Run 'palpate help COMMAND' or 'palpate COMMAND --help' for details and examples.");
  const std::vector<Command> commands = add_commands(program);
  if (const std::string text = text_for_packages(program, argc == 2 ? argv[1] : "");
      !text.empty()) {
    fmt::print("{}", text);
    return kSuccess;
  }
  try {
    program.parse(arguments(program, argc, argv));
  } catch (const CLI::Success& done) {  // --help, --version
    return program.exit(done);
  } catch (const CLI::ParseError& error) {
    return complain(fmt::format("{}{}\nSee 'palpate --help' and 'palpate COMMAND --help'.",
                                reason(error, program), hint(program)),
                    kUsage);
  }
  for (const Command& each : commands) {
    if (each.app->parsed()) return each.run();
  }
  throw UsageError(
      "no command given; use touch, align, info, tile, bag, replay, cameras, devices, ros, doctor, "
      "paper, demo or zwidth (see 'palpate --help')");
}

}  // namespace
}  // namespace palpate::app

int main(int argc, char** argv) {
  using namespace palpate::app;
  try {
    return printed(run(argc, argv));
  } catch (const UsageError& error) {
    return complain(error.what(), kUsage);
  } catch (const std::bad_alloc&) {
    return complain("out of memory; give a smaller cloud or a larger --voxel", kFailure);
  } catch (const std::exception& error) {
    return complain(error.what(), kFailure);
  }
}
