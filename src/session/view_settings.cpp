// Settings that a page can change during a run.
#include "session/view_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "field/description.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/exploration.hpp"
#include "scene/description.hpp"
#include "session/materials.hpp"

namespace palpate::session {

namespace {

constexpr const char* kAutomatic = "automatic";
constexpr double kSliderSteps = 80;   // of a slider, about
constexpr double kWidestVoxel = 10;   // spacings
constexpr double kUsualVoxel = 0.05;  // m, where no spacing is measured
constexpr double kWidestWave = 0.01;  // m of the hand: longer waves are felt as shape

// 1, 2 or 5 times a power of ten, next to `value` by ratio.
double round_step(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const double digit = value / power;
  return power * (digit < std::sqrt(2.)    ? 1
                  : digit < std::sqrt(10.) ? 2
                  : digit < std::sqrt(50.) ? 5
                                           : 10);
}

struct Unit {
  const char* name;
  double metres;
};

double widest_voxel(const ViewScope& scope) {
  return scope.spacing > 0 ? kWidestVoxel * scope.spacing : kUsualVoxel;
}

// One unit for all lengths during the whole run.
Unit unit_of(const ViewScope& scope) {
  return widest_voxel(scope) < 1 ? Unit{"mm", 1e-3} : Unit{"m", 1};
}

Setting number(const char* key, const char* label, const char* unit, double least, double most,
               double step, double value) {
  return {.key = key,
          .label = label,
          .unit = unit,
          .least = least,
          .most = most,
          .step = step,
          .value = value};
}

// A texture has a wavelength above 0.
Setting wavelength_setting(const Unit& unit, double most, double value) {
  most = std::max(most, value) / unit.metres;
  value /= unit.metres;
  const double step = round_step(most / kSliderSteps);
  return number("wavelength", "Wavelength", unit.name, std::min(step, value), most, step, value);
}

// A length from 0 to `most`, m.
Setting length_setting(const char* key, const char* label, const Unit& unit, double most,
                       double value) {
  most = std::max(most, value) / unit.metres;
  return number(key, label, unit.name, 0, most, round_step(most / kSliderSteps),
                value / unit.metres);
}

Setting choice(const char* key, const char* label, std::vector<std::string> choices,
               const char* value) {
  return {.key = key,
          .label = label,
          .kind = Setting::Kind::choice,
          .choices = std::move(choices),
          .value = std::string(value)};
}

std::vector<std::string> policies(const ViewScope& scope) {
  std::vector<std::string> names = {kAutomatic};
  for (const Named<Policy>& each : kPolicies) {
    if (each.choice != Policy::morph || (scope.depth && !scope.clouds))
      names.emplace_back(each.name);
  }
  return names;
}

void set_friction(ContactSettings& feel, double value) {
  feel.friction.dynamic_coefficient = value;
  feel.friction.static_coefficient = value;
}

FieldOptions other_kind(FieldOptions field, FieldOptions::Kind kind) {
  if (field.raw_weights) return paper_field(kind);
  field.kind = kind;
  return field;
}

// `scale`: world metres of a metre of the hand.
void make_of(const Material& material, double scale, ContactSettings& feel) {
  feel.stiffness *= material.stiffness;
  set_friction(feel, material.friction);
  feel.texture = {scale * material.texture.amplitude, scale * material.texture.wavelength};
}

void make_paper(ViewSettings& settings) {
  settings.field = paper_field();
  settings.preparation.policy = Policy::average;
  settings.feel.texture = {};
}

}  // namespace

ViewScope scope_of(const Scene& scene, double scale, const std::vector<Servo*>& servos) {
  ViewScope scope;
  scope.scale = scale;
  scope.stiffest = kSteadyStiffness / scale;
  for (const Servo* servo : servos) {
    scope.stiffest = std::min(scope.stiffest, servo->stiffness_limit());
  }
  const double deepest = deepest_texture(scene);
  scope.deepest_texture = std::isfinite(deepest) ? deepest : 0;
  return scope;
}

std::vector<Setting> list_settings(const ViewSettings& settings, const ViewScope& scope) {
  const Unit unit = unit_of(scope);
  std::vector<Setting> list;
  list.push_back(
      choice("field", "Surface", names_of(kFields), name_in(kFields, settings.field.kind)));
  list.push_back(number("stiffness", "Stiffness", "N/m", 0, scope.stiffest,
                        round_step(scope.stiffest / kSliderSteps), settings.feel.stiffness));
  list.push_back(
      number("friction", "Friction", "", 0, 1.5, 0.05, settings.feel.friction.dynamic_coefficient));
  if (scope.deepest_texture > 0) {
    list.push_back(length_setting("texture", "Texture", unit, scope.deepest_texture,
                                  settings.feel.texture.amplitude));
    list.push_back(
        wavelength_setting(unit, kWidestWave * scope.scale, settings.feel.texture.wavelength));
  }
  if (scope.lives || scope.clouds) {
    list.push_back(
        number("smoothing", "Smoothing", "", 0.5, 3, 0.1, settings.preparation.smoothing));
  }
  if (scope.lives) {
    const char* const policy =
        settings.preparation.policy ? name_in(kPolicies, *settings.preparation.policy) : kAutomatic;
    list.push_back(choice("policy", "Time", policies(scope), policy));
    list.push_back(number("history", "History", "clouds", 1, 7, 1, settings.preparation.history));
  }
  if (scope.clouds) {
    list.push_back(length_setting("voxel", "Voxel (0: automatic)", unit, widest_voxel(scope),
                                  settings.preparation.voxel.value_or(0)));
  }
  return list;
}

void set(ViewSettings& settings, const ViewScope& scope, const std::string& key,
         const Setting::Value& value) {
  if (key == "field") {
    settings.field = other_kind(settings.field, *choice_of(kFields, std::get<std::string>(value)));
  } else if (key == "policy") {
    settings.preparation.policy = choice_of(kPolicies, std::get<std::string>(value));
  } else if (key == "history") {
    settings.preparation.history = static_cast<int>(std::lround(std::get<double>(value)));
  } else if (key == "smoothing") {
    settings.preparation.smoothing = std::get<double>(value);
  } else if (key == "voxel") {
    const double voxel = std::get<double>(value) * unit_of(scope).metres;
    settings.preparation.voxel = voxel > 0 ? std::optional<double>(voxel) : std::nullopt;
  } else if (key == "stiffness") {
    settings.feel.stiffness = std::get<double>(value);
  } else if (key == "friction") {
    set_friction(settings.feel, std::get<double>(value));
  } else if (key == "texture") {
    settings.feel.texture.amplitude = std::get<double>(value) * unit_of(scope).metres;
  } else if (key == "wavelength") {
    settings.feel.texture.wavelength = std::get<double>(value) * unit_of(scope).metres;
  } else {
    throw Error(fmt::format("unknown setting '{}'", key));
  }
}

std::vector<std::string> preset_names(bool turns) {
  std::vector<std::string> names = {"default"};
  if (!turns) names.emplace_back("paper");
  for (const Material& each : kMaterials) names.emplace_back(each.name);
  return names;
}

ViewSettings preset(const ViewSettings& initial, const std::string& name, const ViewScope& scope) {
  ViewSettings result = initial;
  ContactSettings& feel = result.feel;
  const auto material = std::ranges::find(kMaterials, name, &Material::name);
  if (material != kMaterials.end()) {
    make_of(*material, scope.scale, feel);
  } else if (name == "paper") {
    make_paper(result);
  } else if (name != "default") {
    throw Error(fmt::format("unknown preset '{}'", name));
  }
  feel.stiffness = std::min(feel.stiffness, scope.stiffest);
  feel.texture.amplitude = std::min(feel.texture.amplitude, scope.deepest_texture);
  return result;
}

SourceOptions prepared_by(const ViewSettings::Preparation& wanted,
                          const ViewSettings::Preparation& initial, const SourceOptions& own) {
  SourceOptions options = own;
  if (wanted.policy != initial.policy) options.policy.policy = wanted.policy;
  if (wanted.history != initial.history) options.policy.history = wanted.history;
  if (wanted.voxel != initial.voxel) options.prepare.voxel = wanted.voxel;
  if (wanted.smoothing == initial.smoothing) return options;
  const double wider = wanted.smoothing / initial.smoothing;
  options.depth.normal_error /= wider;
  if (options.prepare.radius) {
    *options.prepare.radius *= wider;
  } else {
    options.prepare.smoothing = own.prepare.smoothing * wider;
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

}  // namespace palpate::session
