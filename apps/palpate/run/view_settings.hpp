// Settings that a page can change during a run.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "apps/palpate/run/run.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

using Setting = ViewerControls::Setting;

/// Settings that a page may change during a run.
struct ViewSettings {
  /// How sources are prepared.
  struct Preparation {
    std::optional<Policy> policy;  ///< unset: as each kind of source has it
    int history = 4;
    double smoothing = 1;         ///< of what the noise asks for: windows and radii grow with it
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

/// The settings with their bounds as a page shows them: lengths in mm, or in m for large scenes.
[[nodiscard]] std::vector<Setting> list_settings(const ViewSettings& settings,
                                                 const ViewScope& scope);

/// `value` as it is listed. @throws Error when there is no such key.
void set(ViewSettings& settings, const ViewScope& scope, const std::string& key,
         const Setting::Value& value);

/// The names that preset() knows.
[[nodiscard]] std::vector<std::string> preset_names();

/// What a run began with, but for what the preset of that name says, within the bounds of `scope`.
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

/// Prepares the sources of a run again, on a thread of its own, with the settings of the page.
/// If requests come faster than it works, the last one counts. A failed request is undone.
class Preparer {
 public:
  using Preparation = ViewSettings::Preparation;
  /// Called on the preparer's thread: why a preparation failed, and what sources are prepared by.
  using Failed = std::function<void(const std::string& why, const Preparation& held)>;

  /// `initial`: what the run began with. The run outlives it.
  Preparer(Run& run, const Preparation& initial, Failed failed);
  ~Preparer();
  Preparer(const Preparer&) = delete;
  Preparer& operator=(const Preparer&) = delete;

  /// Waits for what is under way and begins nothing any more.
  void stop();

  /// Any thread; returns at once.
  void want(const Preparation& wanted);

 private:
  void work(const std::stop_token& stop);
  void prepare(const Preparation& wanted);
  void change_all(const Preparation& wanted);
  void finish_cut_off();

  Run& run_;
  Preparation initial_;
  Preparation held_;               // the last that sources could be prepared by
  std::set<std::size_t> cut_off_;  // sources that were being prepared when another way was wanted
  Failed failed_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Preparation> wanted_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate::app
