#include "apps/palpate/run/view_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "apps/palpate/cli/names.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

constexpr double kMillimetre = 1e-3;
constexpr const char* kAutomatic = "automatic";

ViewerControls::Setting number(const char* key, const char* label, const char* unit, double least,
                               double most, double step, double value) {
  ViewerControls::Setting setting;
  setting.key = key;
  setting.label = label;
  setting.unit = unit;
  setting.least = least;
  setting.most = most;
  setting.step = step;
  setting.value = value;
  return setting;
}

ViewerControls::Setting choice(const char* key, const char* label, std::vector<std::string> choices,
                               const char* value) {
  ViewerControls::Setting setting;
  setting.key = key;
  setting.label = label;
  setting.kind = ViewerControls::Setting::Kind::choice;
  setting.choices = std::move(choices);
  setting.value = std::string(value);
  return setting;
}

std::vector<std::string> policies(const ViewScope& scope) {
  std::vector<std::string> names = {kAutomatic};
  for (const Named<Policy>& each : kPolicies) {
    if (each.choice != Policy::morph || (scope.depth && !scope.clouds))
      names.emplace_back(each.name);
  }
  return names;
}

void set_contact(ContactSettings& feel, const std::string& key, double value) {
  if (key == "stiffness") feel.stiffness = value;
  if (key == "texture") feel.texture.amplitude = value * kMillimetre;
  if (key != "friction") return;
  feel.friction.dynamic_coefficient = value;
  feel.friction.static_coefficient = value;
}

FieldOptions other_kind(FieldOptions field, FieldKind kind) {
  if (field.raw_weights) return paper_field(kind);
  field.kind = kind;
  return field;
}

struct Preset {
  const char* name;
  void (*apply)(ViewSettings&);
};

constexpr std::array<Preset, 4> kPresets = {{
    {"default", [](ViewSettings&) {}},
    {"paper",
     [](ViewSettings& settings) {
       settings.field = paper_field();
       settings.policy = Policy::average;
       settings.feel.texture = {};
     }},
    {"soft",
     [](ViewSettings& settings) {
       settings.feel.stiffness *= 0.3;
       set_contact(settings.feel, "friction", 0.4);
     }},
    {"glass",
     [](ViewSettings& settings) {
       settings.feel.stiffness *= 2.4;
       set_contact(settings.feel, "friction", 0);
     }},
}};

}  // namespace

std::vector<ViewerControls::Setting> list_settings(const ViewSettings& settings,
                                                   const ViewScope& scope) {
  std::vector<ViewerControls::Setting> list;
  list.push_back(
      choice("field", "Surface", names_of(kFields), name_in(kFields, settings.field.kind)));
  list.push_back(
      number("stiffness", "Stiffness", "N/m", 0, scope.stiffest, 10, settings.feel.stiffness));
  list.push_back(
      number("friction", "Friction", "", 0, 1.5, 0.05, settings.feel.friction.dynamic_coefficient));
  if (scope.deepest_texture > 0) {
    list.push_back(number("texture", "Texture", "mm", 0, scope.deepest_texture / kMillimetre, 0.01,
                          settings.feel.texture.amplitude / kMillimetre));
  }
  if (scope.lives || scope.clouds) {
    list.push_back(number("smoothing", "Smoothing", "", 0.5, 3, 0.1, settings.smoothing));
  }
  if (scope.lives) {
    const char* const policy = settings.policy ? name_in(kPolicies, *settings.policy) : kAutomatic;
    list.push_back(choice("policy", "Time", policies(scope), policy));
    list.push_back(number("history", "History", "clouds", 1, 7, 1, settings.history));
  }
  if (scope.clouds) {
    list.push_back(number("voxel", "Voxel (0: automatic)", "mm", 0, 50, 0.5,
                          settings.voxel.value_or(0) / kMillimetre));
  }
  return list;
}

bool prepares_alike(const ViewSettings& one, const ViewSettings& other) {
  return one.smoothing == other.smoothing && one.policy == other.policy &&
         one.history == other.history && one.voxel == other.voxel;
}

ViewSettings with_preparation(ViewSettings settings, const ViewSettings& other) {
  settings.smoothing = other.smoothing;
  settings.policy = other.policy;
  settings.history = other.history;
  settings.voxel = other.voxel;
  return settings;
}

void set(ViewSettings& settings, const std::string& key,
         const ViewerControls::Setting::Value& value) {
  if (key == "field") {
    settings.field = other_kind(settings.field, *choice_of(kFields, std::get<std::string>(value)));
  } else if (key == "policy") {
    settings.policy = choice_of(kPolicies, std::get<std::string>(value));
  } else if (key == "history") {
    settings.history = static_cast<int>(std::lround(std::get<double>(value)));
  } else if (key == "smoothing") {
    settings.smoothing = std::get<double>(value);
  } else if (key == "voxel") {
    const double voxel = std::get<double>(value) * kMillimetre;
    settings.voxel = voxel > 0 ? std::optional<double>(voxel) : std::nullopt;
  } else if (key == "stiffness" || key == "friction" || key == "texture") {
    set_contact(settings.feel, key, std::get<double>(value));
  } else {
    throw Error(fmt::format("unknown setting '{}'", key));
  }
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& each : kPresets) names.emplace_back(each.name);
  return names;
}

ViewSettings preset(const ViewSettings& initial, const std::string& name, const ViewScope& scope) {
  for (const Preset& each : kPresets) {
    if (name != each.name) continue;
    ViewSettings result = initial;
    each.apply(result);
    ContactSettings& feel = result.feel;
    feel.stiffness = std::min(feel.stiffness, scope.stiffest);
    feel.texture.amplitude = std::min(feel.texture.amplitude, scope.deepest_texture);
    return result;
  }
  throw Error(fmt::format("unknown preset '{}'", name));
}

SourceOptions prepared_by(const ViewSettings& settings, const ViewSettings& initial,
                          const SourceOptions& own) {
  constexpr double kRadiusMultiple = 2.5;
  SourceOptions options = own;
  if (settings.policy != initial.policy) options.policy.policy = settings.policy;
  if (settings.history != initial.history) options.policy.history = settings.history;
  if (settings.voxel != initial.voxel) options.prepare.voxel = settings.voxel;
  if (settings.smoothing == initial.smoothing) return options;
  const double wider = settings.smoothing / initial.smoothing;
  options.depth.normal_error /= wider;
  if (options.prepare.radius) {
    *options.prepare.radius *= wider;
  } else {
    options.prepare.radius_multiple = own.prepare.radius_multiple.value_or(kRadiusMultiple) * wider;
  }
  return options;
}

double deepest_texture(const Scene& scene) {
  // The relief goes 2 amplitudes deep, and weights run out at about half an R under the points.
  constexpr double kDeepest = 0.2;  // R
  double largest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> points = scene.source(i).points();
    if (points && points->size() > 0) largest = std::min(largest, kDeepest * points->radius);
  }
  return largest;
}

Preparer::Preparer(Run& run, const ViewSettings& initial, Failed failed)
    : run_(run),
      initial_(initial),
      held_(initial),
      failed_(std::move(failed)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

Preparer::~Preparer() = default;

void Preparer::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Preparer::want(const ViewSettings& settings) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = settings;
  }
  changed_.notify_one();
}

void Preparer::work(const std::stop_token& stop) {
  while (true) {
    ViewSettings settings;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return wanted_.has_value(); })) return;
      settings = *std::exchange(wanted_, std::nullopt);
    }
    try {
      prepare(settings);
      held_ = settings;
    } catch (const std::exception& error) {
      take_back();
      failed_(error.what(), held_);
    }
  }
}

// What lives is prepared so from its next frame on.
void Preparer::prepare(const ViewSettings& settings) {
  for (std::size_t i = 0; i < run_.loaded.sources.size(); ++i) {
    Source& source = run_.loaded.scene.source(i);
    const LoadedSource& loaded = run_.loaded.sources[i];
    source.change(prepared_by(settings, initial_, loaded.plan.options));
    if (loaded.cloud) source.set(*loaded.cloud);
  }
}

// What could not be prepared has left its surface as it was; frames to come go on as before.
void Preparer::take_back() {
  for (std::size_t i = 0; i < run_.loaded.sources.size(); ++i) {
    const SourceOptions& options = run_.loaded.sources[i].plan.options;
    run_.loaded.scene.source(i).change(prepared_by(held_, initial_, options));
  }
}

}  // namespace palpate::app
