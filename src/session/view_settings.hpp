// Settings that a page can change during a run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palpate/field/field_options.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::session {

using Setting = ViewerControls::Setting;

/// Settings that a page may change during a run.
struct ViewSettings {
  /// How sources are prepared.
  struct Preparation {
    std::optional<Policy> policy;  ///< unset: as each kind of source has it
    int history = 4;
    double smoothing = 1;         ///< of what the noise requires: windows and radii grow with it
    std::optional<double> voxel;  ///< of clouds, m; unset: chosen from the data

    bool operator==(const Preparation&) const = default;
  };

  FieldOptions field;
  ContactSettings feel;
  Preparation preparation;
};

/// What the settings of a run are limited by.
struct ViewScope {
  double stiffest = 2000;      ///< N/m, in the world
  double deepest_texture = 0;  ///< amplitude, m
  double scale = 1;            ///< world metres of a metre of the hand
  double spacing = 0;          ///< of the clouds that stand still as they were read, the widest, m
  bool lives = false;          ///< frames or clouds follow one another in time
  bool depth = false;          ///< ... and are depth images
  bool clouds = false;         ///< clouds are prepared here
};

/// What `scene` and `servos` allow to be felt, at so many world metres of a metre of the hand; what
/// sources report is to be added. No stiffer than every hand's device bears.
[[nodiscard]] ViewScope scope_of(const Scene& scene, double scale,
                                 const std::vector<Servo*>& servos);

/// The settings with their bounds as a page shows them: lengths in mm, or in m for large scenes.
[[nodiscard]] std::vector<Setting> list_settings(const ViewSettings& settings,
                                                 const ViewScope& scope);

/// `value` as it is listed. @throws Error when there is no such key.
void set(ViewSettings& settings, const ViewScope& scope, const std::string& key,
         const Setting::Value& value);

/// The names that preset() accepts. `turns`: of hands that hold a tool that turns.
[[nodiscard]] std::vector<std::string> preset_names(bool turns = false);

/// What a run began with, but for what the preset of that name sets, within the bounds of `scope`.
/// @throws Error when there is none.
[[nodiscard]] ViewSettings preset(const ViewSettings& initial, const std::string& name,
                                  const ViewScope& scope);

/// `own`, which a source began with, but for what `wanted` has other than `initial`.
[[nodiscard]] SourceOptions prepared_by(const ViewSettings::Preparation& wanted,
                                        const ViewSettings::Preparation& initial,
                                        const SourceOptions& own);

/// The largest amplitude of a texture, m, that a hand can meet on the thinnest surface of `scene`;
/// infinite where it has none.
[[nodiscard]] double deepest_texture(const Scene& scene);

}  // namespace palpate::session
