#include "session/view_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "palpate/base/error.hpp"

namespace palpate::session {
namespace {

constexpr ViewScope kAll = {.deepest_texture = 1e-3, .lives = true, .depth = true, .clouds = true};

const Setting* find(const std::vector<Setting>& list, const std::string& key) {
  const auto found = std::ranges::find(list, key, &Setting::key);
  return found == list.end() ? nullptr : &*found;
}

TEST(ViewSettings, WhatIsSetIsWhatIsListed) {
  ViewSettings settings;
  const std::vector<std::pair<std::string, Setting::Value>> wanted = {
      {"field", std::string("metaball")},
      {"stiffness", 320.0},
      {"friction", 0.3},
      {"texture", 0.5},
      {"wavelength", 3.0},
      {"smoothing", 1.5},
      {"policy", std::string("average")},
      {"history", 2.0},
      {"voxel", 4.0}};
  for (const auto& [key, value] : wanted) set(settings, kAll, key, value);
  const std::vector<Setting> list = list_settings(settings, kAll);
  EXPECT_EQ(list.size(), wanted.size());
  for (const auto& [key, value] : wanted) {
    const Setting* const setting = find(list, key);
    ASSERT_NE(setting, nullptr) << key;
    EXPECT_EQ(setting->value, value) << key;
  }
  EXPECT_EQ(settings.field.kind, FieldOptions::Kind::metaball);
  EXPECT_EQ(settings.feel.stiffness, 320);
  EXPECT_DOUBLE_EQ(settings.feel.texture.amplitude, 0.5e-3);
  EXPECT_DOUBLE_EQ(settings.feel.texture.wavelength, 3e-3);
  EXPECT_EQ(settings.feel.friction.static_coefficient, 0.3);
}

TEST(ViewSettings, PresentValuesAreWithinTheirBounds) {
  for (const std::string& name : preset_names()) {
    for (const Setting& setting : list_settings(preset({}, name, kAll), kAll)) {
      if (setting.kind == Setting::Kind::number) {
        EXPECT_GE(std::get<double>(setting.value), setting.least) << name << ' ' << setting.key;
        EXPECT_LE(std::get<double>(setting.value), setting.most) << name << ' ' << setting.key;
      } else {
        EXPECT_TRUE(std::ranges::count(setting.choices, std::get<std::string>(setting.value)))
            << name << ' ' << setting.key;
      }
    }
  }
}

TEST(ViewSettings, OfAToolThatTurnsThereIsNoPaper) {
  const std::vector<std::string> names = preset_names(true);
  EXPECT_EQ(std::ranges::count(names, "paper"), 0);
  EXPECT_EQ(names.size() + 1, preset_names().size());
}

TEST(ViewSettings, OfCloudsThatStandStillThereIsNoTimeToSet) {
  const std::vector<Setting> list = list_settings({}, {.clouds = true});
  EXPECT_EQ(find(list, "policy"), nullptr);
  EXPECT_EQ(find(list, "history"), nullptr);
  EXPECT_EQ(find(list, "texture"), nullptr) << "nothing is known that could carry one";
  EXPECT_NE(find(list, "voxel"), nullptr);
}

TEST(ViewSettings, PresetsStartFromWhatTheRunBeganWith) {
  ViewSettings initial;
  initial.feel.stiffness = 200;
  EXPECT_EQ(preset(initial, "default", kAll).feel.stiffness, 200);
  const ViewSettings paper = preset(initial, "paper", kAll);
  EXPECT_TRUE(paper.field.raw_weights);
  EXPECT_EQ(paper.preparation.policy, Policy::average);
  EXPECT_NO_THROW(check(paper.field));
  EXPECT_THROW((void)preset(initial, "stone", kAll), Error);
}

TEST(ViewSettings, FurRubberWoodAndIceAreEachStifferThanTheOneBefore) {
  double before = 0;
  for (const char* const name : {"fur", "rubber", "wood", "ice"}) {
    const ContactSettings feel = preset({}, name, kAll).feel;
    EXPECT_GT(feel.stiffness, before) << name;
    EXPECT_EQ(feel.friction.static_coefficient, feel.friction.dynamic_coefficient) << name;
    before = feel.stiffness;
  }
  const auto friction = [](const char* name) {
    return preset({}, name, kAll).feel.friction.dynamic_coefficient;
  };
  EXPECT_LT(friction("ice"), friction("wood"));
  EXPECT_LT(friction("wood"), friction("fur"));
  EXPECT_LT(friction("fur"), friction("rubber"));
}

TEST(ViewSettings, TexturesOfPresetsAreSmoothUnderANewton) {
  for (const double scale : {0.1, 1.0, 50.0}) {
    ViewScope scope = kAll;
    scope.scale = scale;
    scope.stiffest /= scale;
    scope.deepest_texture *= scale;
    ViewSettings initial;
    initial.feel.stiffness /= scale;
    initial.feel.texture.amplitude = 1e-4 * scale;
    for (const char* const name : {"fur", "wood"}) {
      const ContactSettings feel = preset(initial, name, scope).feel;
      const double depth = 1 / feel.stiffness;
      const Texture& texture = feel.texture;
      EXPECT_GT(texture.amplitude, 0) << name;
      EXPECT_LE(texture.amplitude, texture.wavelength * texture.wavelength / (40 * depth) * 1.0001)
          << name << ' ' << scale;
    }
    for (const char* const name : {"ice", "rubber"})
      EXPECT_EQ(preset(initial, name, scope).feel.texture.amplitude, 0) << name;
  }
}

TEST(ViewSettings, AnotherKindOfThePapersSurfaceIsThePapers) {
  ViewSettings settings = preset({}, "paper", kAll);
  set(settings, kAll, "field", std::string("pointset"));
  EXPECT_EQ(settings.field.kind, FieldOptions::Kind::pointset);
  EXPECT_EQ(settings.field.gradient, FieldOptions::Gradient::normal);
}

TEST(ViewSettings, PreparationFollowsThoseThatAreItsOwn) {
  ViewSettings settings;
  set(settings, kAll, "smoothing", 2.0);
  set(settings, kAll, "voxel", 5.0);
  set(settings, kAll, "policy", std::string("replace"));
  const SourceOptions options = prepared_by(settings.preparation, {}, {});
  EXPECT_DOUBLE_EQ(options.depth.normal_error, DepthFilterOptions().normal_error / 2);
  EXPECT_DOUBLE_EQ(options.prepare.smoothing, 2);
  EXPECT_DOUBLE_EQ(*options.prepare.voxel, 5e-3);
  EXPECT_EQ(*options.policy.policy, Policy::replace);
}

TEST(ViewSettings, WhatIsOnlyFeltPreparesNothingAnew) {
  const std::vector<std::pair<std::string, Setting::Value>> felt = {
      {"field", std::string("metaball")},
      {"stiffness", 320.0},
      {"friction", 0.3},
      {"texture", 0.5},
      {"wavelength", 3.0}};
  ViewSettings settings;
  for (const auto& [key, value] : felt) set(settings, kAll, key, value);
  EXPECT_EQ(settings.preparation, ViewSettings::Preparation{});
  EXPECT_EQ(preset({}, "wood", kAll).preparation, ViewSettings::Preparation{});
  const std::vector<std::pair<std::string, Setting::Value>> prepared = {
      {"smoothing", 1.5}, {"policy", std::string("average")}, {"history", 2.0}, {"voxel", 4.0}};
  for (const auto& [key, value] : prepared) {
    ViewSettings other;
    set(other, kAll, key, value);
    EXPECT_NE(other.preparation, ViewSettings::Preparation{}) << key;
  }
}

TEST(ViewSettings, PresetsKeepToTheBounds) {
  ViewSettings initial;
  initial.feel.stiffness = 1500;
  initial.feel.texture.amplitude = 5e-3;
  EXPECT_EQ(preset(initial, "ice", kAll).feel.stiffness, kAll.stiffest);
  EXPECT_EQ(preset(initial, "default", kAll).feel.texture.amplitude, kAll.deepest_texture);
  ViewScope thin = kAll;
  thin.deepest_texture = 1e-5;
  EXPECT_EQ(preset(initial, "wood", thin).feel.texture.amplitude, thin.deepest_texture);
}

TEST(ViewSettings, NothingIsListedThatWouldDoNothing) {
  EXPECT_EQ(find(list_settings({}, {}), "smoothing"), nullptr) << "neither clouds nor cameras";
  EXPECT_NE(find(list_settings({}, {.clouds = true}), "smoothing"), nullptr);
}

TEST(ViewSettings, WhatASourceHasOfItsOwnStaysUnlessThePageChangesIt) {
  SourceOptions own;
  own.depth.normal_error = 0.01;
  own.prepare.radius = 0.02;
  own.prepare.voxel = 3e-3;
  own.policy.policy = Policy::replace;
  own.policy.history = 6;
  const ViewSettings initial;
  ViewSettings settings = preset(initial, "wood", kAll);
  SourceOptions options = prepared_by(settings.preparation, initial.preparation, own);
  EXPECT_EQ(options.depth.normal_error, 0.01);
  EXPECT_EQ(options.prepare.radius, 0.02);
  EXPECT_EQ(options.prepare.smoothing, 1);
  EXPECT_EQ(options.prepare.voxel, 3e-3);
  EXPECT_EQ(options.policy.policy, Policy::replace);
  EXPECT_EQ(options.policy.history, 6);
  set(settings, kAll, "smoothing", 2.0);
  set(settings, kAll, "policy", std::string("average"));
  options = prepared_by(settings.preparation, initial.preparation, own);
  EXPECT_DOUBLE_EQ(options.depth.normal_error, 0.005);
  EXPECT_DOUBLE_EQ(*options.prepare.radius, 0.04);
  EXPECT_EQ(options.prepare.voxel, 3e-3);
  EXPECT_EQ(options.policy.policy, Policy::average);
  EXPECT_EQ(options.policy.history, 6);
}

// From the whole of a cloud of 0.1 m to one of 5 km: 40 000 points on a square, and the stiffness
// of a hand of 0.1 m in it.
TEST(ViewSettings, BoundsAndStepsAreThoseOfTheCloud) {
  for (const double size : {0.1, 0.2, 1.0, 7.3, 50.0, 425.0, 5000.0}) {
    const double scale = size / 0.1;
    ViewScope scope = {.clouds = true};
    scope.stiffest = 2000 / scale;
    scope.scale = scale;
    scope.spacing = size / 200;
    scope.deepest_texture = 0.5 * scope.spacing;
    ViewSettings settings;
    settings.feel.stiffness = 0.43 * scope.stiffest;
    settings.feel.texture.amplitude = 0.37 * scope.deepest_texture;
    settings.feel.texture.wavelength = 4e-3 * scale;
    settings.preparation.voxel = 2.1 * scope.spacing;
    int numbers = 0;
    for (const Setting& setting : list_settings(settings, scope)) {
      if (setting.kind != Setting::Kind::number || setting.step == 1) continue;
      const double steps = (setting.most - setting.least) / setting.step;
      EXPECT_GE(steps, 20) << size << " m " << setting.key;
      EXPECT_LE(steps, 160) << size << " m " << setting.key;
      ViewSettings same = settings;
      set(same, scope, setting.key, setting.value);
      EXPECT_DOUBLE_EQ(same.feel.stiffness, settings.feel.stiffness);
      EXPECT_DOUBLE_EQ(same.feel.texture.amplitude, settings.feel.texture.amplitude);
      EXPECT_DOUBLE_EQ(*same.preparation.voxel, *settings.preparation.voxel);
      ++numbers;
    }
    EXPECT_GT(numbers, 3) << size << " m";
  }
}

TEST(ViewSettings, UnknownKeysAreRefused) {
  ViewSettings settings;
  EXPECT_THROW(set(settings, kAll, "colour", 1.0), Error);
}

}  // namespace
}  // namespace palpate::session
