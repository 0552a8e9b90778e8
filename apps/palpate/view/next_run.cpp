// Offers other scenes and other units as settings.
#include "apps/palpate/view/next_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/run/opening.hpp"
#include "session/length_unit.hpp"

namespace palpate::app {
namespace {

struct Example {
  const char* name;
  const char* source;
};

// One scan, one camera and one room: each is prepared within a second.
constexpr std::array<Example, 3> kExamples = {{{"rabbit", "rabbit=synthetic:rabbit"},
                                               {"desk", "desk=camera:simulated:desk"},
                                               {"room", "room=synthetic:room"}}};

// Is it a camera, which nobody else may open meanwhile, or what can be read once alone?
bool opens_once(const LoadedSource& source) {
  const std::string& path = source.plan.argument.path;
  std::error_code unknown;
  return source.camera != nullptr || path == "-" || path.starts_with("/dev/") ||
         std::filesystem::is_fifo(path, unknown);
}

bool has_unit(const LoadedSource& source) {
  return source.plan.kind == SourceKind::cloud && !source.plan.reading.length &&
         !source.plan.argument.path.starts_with(kSynthetic);
}

Setting unit_setting_of(const LoadedSource& source, const Source& felt) {
  std::optional<session::UnitQuestion> question;
  const std::shared_ptr<const PointCloud> cloud =
      source.cloud ? source.cloud : felt.state().overview;
  if (source.units.metres > 0 && cloud) question = {session::core_of(*cloud), source.units.metres};
  return session::unit_setting(source.plan.argument.name, source.unit.plan, question);
}

Setting scene_setting(const LoadedScene& loaded) {
  Setting setting{.key = "scene", .label = "Scene", .kind = Setting::Kind::choice};
  for (const Example& each : kExamples) setting.choices.emplace_back(each.name);
  std::string present;
  for (const LoadedSource& source : loaded.sources) {
    present += (present.empty() ? "" : " + ") + source.plan.argument.name;
  }
  if (!std::ranges::count(setting.choices, present)) setting.choices.push_back(present);
  setting.value = present;
  setting.restarts = true;
  return setting;
}

}  // namespace

NextRun::NextRun(const Run& run) : run_(run) {
  if (run.opening == nullptr) return;
  settings_.push_back(scene_setting(run.loaded));
  if (std::ranges::any_of(run.loaded.sources, opens_once)) return;
  for (std::size_t i = 0; i < run.loaded.sources.size(); ++i) {
    const LoadedSource& source = run.loaded.sources[i];
    if (has_unit(source)) settings_.push_back(unit_setting_of(source, run.loaded.scene.source(i)));
  }
}

bool NextRun::set(const std::string& key, const Setting::Value& value) {
  const auto setting = std::ranges::find(settings_, key, &Setting::key);
  if (setting == settings_.end()) return false;
  if (value == setting->value) return true;
  const std::string& wanted = std::get<std::string>(value);
  if (key == "scene") {
    const auto example = std::ranges::find(kExamples, wanted, &Example::name);
    run_.opening->begin({wanted, Opening::Sources{{example->source}}});
    return true;
  }
  const std::optional<std::string> name = session::source_of_unit(key);
  const std::optional<double> metres = session::metres_of_unit(wanted);
  if (!name || !metres) return false;
  const auto& sources = run_.loaded.sources;
  const auto source = std::ranges::find_if(
      sources, [&](const LoadedSource& each) { return each.plan.argument.name == name; });
  const auto index = static_cast<std::size_t>(source - sources.begin());
  run_.opening->begin({fmt::format("{} in {}", *name, wanted), Opening::OtherUnit{index, *metres}});
  return true;
}

}  // namespace palpate::app
