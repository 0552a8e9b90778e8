#include "apps/palpate/touch/demo_command.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <vector>

#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/options/device_choice.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/touch/touch_command.hpp"

namespace palpate::app {

namespace {

struct DemoScene {
  const char* name;
  const char* description;
  std::array<const char*, 2> sources;  // null: none
};

constexpr std::array<DemoScene, 5> kScenes = {{
    {"desk",
     "a depth camera over a table-top with a wire and other things, one of them moving",
     {"desk=camera:simulated:desk", nullptr}},
    {"arm",
     "a table-top as a structured-light sensor sees it, and an arm that goes to and fro over it",
     {"arm=camera:simulated:arm,noise=structured", nullptr}},
    {"scan", "a rabbit, as a scanner would show it", {"rabbit=synthetic:rabbit", nullptr}},
    {"two",
     "two depth cameras that see one scene from two sides, 2 mm off",
     {"left=camera:simulated:table,view=40,phase=0.011,seed=2,error=0.002",
      "right=camera:simulated:table,view=-40"}},
    {"room", "a room of 4 x 3 m, 300 000 points", {"room=synthetic:room", nullptr}},
}};

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const DemoScene& scene : kScenes) result.emplace_back(scene.name);
  return result;
}

std::string list() {
  std::string text = "what is there to touch (desk):";
  for (const DemoScene& scene : kScenes) {
    text += std::string("\n") + scene.name + ": " + scene.description;
  }
  return text;
}

std::vector<std::string> sources_of(const std::string& name) {
  std::vector<std::string> sources;
  for (const DemoScene& scene : kScenes) {
    if (scene.name != name) continue;
    for (const char* source : scene.sources) {
      if (source != nullptr) sources.emplace_back(source);
    }
  }
  return sources;
}

}  // namespace

void add_demo_options(CLI::App& command, DemoOptions& o) {
  command.add_option("scene", o.scene, list())->check(one_of(names()))->type_name("SCENE");
  command
      .add_option("--duration", o.duration,
                  wrapped("ends after this time (without it: when Ctrl-C is pressed)"))
      ->check(number("from 0.1 to 86400 s", [](double x) { return x >= 0.1 && x <= 86'400; }))
      ->type_name("SECONDS");
  command.add_flag("--headless", o.headless, wrapped("opens no browser"));
  add_device_option(command, o.devices, "OPTIONS");
  add_live_options(command, o.live);
  add_page_options(command, o.view);
}

void demo(const DemoOptions& options) {
  TouchOptions touched;
  touched.clouds = sources_of(options.scene);
  touched.devices = options.devices;
  touched.duration = options.duration;
  touched.live = options.live;
  touched.view = options.view;
  touched.view.wanted = true;
  touched.view.open_browser = !options.headless;
  touch(touched);
}

}  // namespace palpate::app
