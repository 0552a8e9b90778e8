#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palpate/field/field_options.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer_options.hpp"

namespace palpate::app {

/// What a viewer's page may change while the tool feels.
struct ViewSettings {
  FieldOptions field;
  Feel feel;
  std::optional<Policy> policy;  ///< unset: as each kind of source has it
  int history = 4;
  double smoothing = 1;         ///< of what the noise asks for: windows and radii grow with it
  std::optional<double> voxel;  ///< of clouds, m; unset: chosen from the data
};

/// What there is to set.
struct ViewScope {
  double stiffest = 2000;      ///< N/m, in the world
  double deepest_texture = 0;  ///< amplitude, m
  bool lives = false;          ///< frames or clouds follow one another in time
  bool depth = false;          ///< ... and are depth images
  bool clouds = false;         ///< clouds are prepared here
};

/// As a page shows them, with their bounds.
[[nodiscard]] std::vector<Setting> list_settings(const ViewSettings& settings,
                                                 const ViewScope& scope);

/// Are sources prepared alike by both?
[[nodiscard]] bool prepares_alike(const ViewSettings& one, const ViewSettings& other);

/// `settings`, but prepared as `other` has it.
[[nodiscard]] ViewSettings with_preparation(ViewSettings settings, const ViewSettings& other);

/// @throws Error when there is no such key.
void set(ViewSettings& settings, const std::string& key, const SettingValue& value);

/// The names that preset() knows.
[[nodiscard]] std::vector<std::string> preset_names();

/// What a run began with, but for what the preset of that name says, within the bounds of `scope`.
/// @throws Error when there is none.
[[nodiscard]] ViewSettings preset(const ViewSettings& initial, const std::string& name,
                                  const ViewScope& scope);

/// `own`, which a source began with, but for what `settings` have other than `initial`.
[[nodiscard]] SourceOptions prepared_by(const ViewSettings& settings, const ViewSettings& initial,
                                        const SourceOptions& own);

}  // namespace palpate::app
