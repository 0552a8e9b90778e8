#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "apps/palpate/align/align_command.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/devices/cameras_command.hpp"
#include "apps/palpate/devices/devices_command.hpp"
#include "apps/palpate/doctor/doctor_command.hpp"
#include "apps/palpate/info/info_command.hpp"
#include "apps/palpate/options/setup_file.hpp"
#include "apps/palpate/paper/paper_command.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "apps/palpate/touch/demo_command.hpp"
#include "apps/palpate/touch/touch_command.hpp"
#include "apps/palpate/zwidth/zwidth_command.hpp"

namespace palpate::app {
namespace {

constexpr const char* kAbout =
    "palpate lets a hand feel a point cloud: it makes an implicit surface of the points and "
    "computes "
    "the force on the hand a thousand times a second.";

int complain(const std::string& what, int code) {
  fmt::print(stderr, "{} {}\n", Style(stderr).error("palpate:"), what);
  return code;
}

int run(int argc, char** argv) {
  CLI::App program(kAbout, "palpate");
  program.set_version_flag("--version", fmt::format("palpate {}", version()));
  program.require_subcommand(0, 1);
  program.get_formatter()->column_width(34);
  program.footer("'palpate COMMAND --help' tells more, with examples.");
  TouchOptions touch_options;
  CLI::App* touch_command =
      program.add_subcommand("touch", "Touch clouds and what cameras see, and report the forces");
  add_touch_options(*touch_command, touch_options);
  AlignOptions align_options;
  CLI::App* align_command =
      program.add_subcommand("align", "Find the poses of cameras and clouds from what they see");
  add_align_options(*align_command, align_options);
  InfoOptions info_options;
  CLI::App* info_command =
      program.add_subcommand("info", "Say what is in a cloud or what a camera delivers");
  add_info_options(*info_command, info_options);
  CamerasOptions cameras_options;
  CLI::App* cameras_command =
      program.add_subcommand("cameras", "List cameras, and what is missing for others");
  add_cameras_options(*cameras_command, cameras_options);
  DoctorOptions doctor_options;
  CLI::App* doctor_app = program.add_subcommand(
      "doctor", "Say what keeps devices from working, or from being in time");
  add_doctor_options(*doctor_app, doctor_options);
  DevicesOptions devices_options;
  CLI::App* devices_command =
      program.add_subcommand("devices", "List haptic devices, and what is missing for others");
  add_devices_options(*devices_command, devices_options);
  PaperCommand paper_command;
  CLI::App* paper_app =
      program.add_subcommand("paper", "Repeat the experiments of Leeper, Chan and Salisbury 2012");
  add_paper_options(*paper_app, paper_command);
  DemoOptions demo_options;
  CLI::App* demo_app =
      program.add_subcommand("demo", "Show a made-up scene on a page, to be touched with a mouse");
  add_demo_options(*demo_app, demo_options);
  ZWidthChoices zwidth_options;
  CLI::App* zwidth_app =
      program.add_subcommand("zwidth", "Map how stiff a surface a device can hold, beside theory");
  add_zwidth_options(*zwidth_app, zwidth_options);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& done) {  // --help, --version
    return program.exit(done);
  } catch (const CLI::ParseError& error) {
    return complain(fmt::format("{}{}\n'palpate --help' and 'palpate COMMAND --help' tell more.",
                                error.what(), hint(program)),
                    kUsage);
  }
  if (program.get_subcommands().empty()) {
    throw UsageError(
        "a command is missing: touch, align, info, cameras, devices, doctor, paper, demo or "
        "zwidth; "
        "'palpate --help' tells more");
  }
  if (touch_command->parsed()) {
    apply_setup(*touch_command, touch_options);
    touch(touch_options);
  }
  if (align_command->parsed()) align_sources(*align_command, align_options);
  if (info_command->parsed()) info(info_options);
  if (cameras_command->parsed()) cameras(cameras_options);
  if (doctor_app->parsed()) return examine(doctor_options);
  if (devices_command->parsed()) devices(devices_options);
  if (paper_app->parsed()) paper(paper_command);
  if (demo_app->parsed()) demo(demo_options);
  if (zwidth_app->parsed()) zwidth(zwidth_options);
  return kSuccess;
}

}  // namespace
}  // namespace palpate::app

int main(int argc, char** argv) {
  using namespace palpate::app;
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    return complain(error.what(), kUsage);
  } catch (const std::bad_alloc&) {
    return complain("there is not enough memory; give a smaller cloud or a larger --voxel",
                    kFailure);
  } catch (const std::exception& error) {
    return complain(error.what(), kFailure);
  }
}
