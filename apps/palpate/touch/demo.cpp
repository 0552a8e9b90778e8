// The command demo: a run that needs no file.
#include <array>
#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/page_options.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/touch/touch.hpp"

namespace palpate::app {

namespace {

struct DemoScene {
  const char* name;
  const char* description;
  std::array<const char*, 2> sources;  // null: none
};

constexpr std::array<DemoScene, 5> kScenes = {{
    {"desk",
     "a depth camera over a table-top with a wire and other objects, one of them moving",
     {"desk=camera:simulated:desk", nullptr}},
    {"arm",
     "a table-top seen by a structured-light sensor, with an arm moving back and forth over it",
     {"arm=camera:simulated:arm,noise=structured", nullptr}},
    {"scan", "a rabbit, like a laser scan", {"rabbit=synthetic:rabbit", nullptr}},
    {"two",
     "two depth cameras that see one scene from two sides, misaligned by 2 mm",
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
  std::string text = "scene to touch (desk):";
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
  TouchPlan& plan = o.touch.plan;
  command.add_option("scene", o.scene, list())->check(one_of(names()))->type_name("SCENE");
  OptionTable table(command);
  table.under("Options");
  table.add("--duration", plan.motion.duration, "SECONDS",
            number("from 0.1 to 86400 s", [](double x) { return x >= 0.1 && x <= 86'400; }),
            "stop after this time (default: at Ctrl-C)");
  add_record_option(table, plan.outputs);
  table.under("Hand, time and page");
  add_device_option(table, plan.devices);
  add_tool_options(table, plan.tool);
  add_live_options(table, plan.time);
  add_page_options(table, plan.page);
}

void demo(const CLI::App& command, const DemoOptions& options) {
  TouchChoices choices = options.touch;
  choices.sources = sources_of(options.scene);
  choices.plan.page.wanted = true;
  touch(plan_touch(command, choices));
}

}  // namespace palpate::app
