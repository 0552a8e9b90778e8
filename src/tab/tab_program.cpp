// Touches a cloud with a simulated hand, and speaks the page's protocol.
#include "tab/tab_program.hpp"

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "session/view_settings.hpp"
#include "tab/tab_hand.hpp"
#include "tab/tab_page.hpp"

namespace palpate::tab {
namespace {

using session::Setting;
using session::ViewSettings;

constexpr std::string_view kSynthetic = "synthetic:";

}  // namespace

Touched synthetic(const std::string& name) {
  const bool prefixed = name.starts_with(kSynthetic);
  std::string plain = prefixed ? name.substr(kSynthetic.size()) : name;
  PointCloud cloud = synthetic_cloud(plain);
  return {std::move(plain), std::move(cloud)};
}

Touched of_file(std::span<const std::byte> bytes, const std::string& name) {
  return {std::filesystem::path(name).stem().string(), read_cloud_bytes(bytes, name).cloud};
}

// The cloud, prepared as the page wants it.
struct TabCloud {
  explicit TabCloud(Touched what)
      : touched(std::move(what)),
        source(scene.add(touched.name, touched.cloud)),
        first(source.options()) {
    preparation.voxel = first.prepare.voxel;
    initial = preparation;
  }

  // What could not be prepared leaves the surface as it was. @throws Error as preparing does.
  void prepare(const ViewSettings::Preparation& wanted) {
    if (wanted == preparation) return;
    source.change(prepared_by(wanted, initial, first));
    try {
      source.set(touched.cloud);
    } catch (...) {
      source.change(prepared_by(preparation, initial, first));
      throw;
    }
    preparation = wanted;
  }

  Touched touched;
  Scene scene;
  Source& source;
  SourceOptions first;                    // as it was at first
  ViewSettings::Preparation initial;      // the same, as settings
  ViewSettings::Preparation preparation;  // by which it is prepared
};

struct TabProgram::Parts {
  Parts(Touched what, Outside outside, const Clock& stopwatch, std::string news)
      : cloud(std::move(what)),
        hand(cloud.scene, stopwatch),
        initial(initial_settings()),
        settings(initial),
        page(cloud.scene, {&hand.servo}, {.scene = cloud.touched.name}, controls(),
             std::move(outside), stopwatch, std::move(news)) {}

  [[nodiscard]] ViewSettings initial_settings() const {
    ViewSettings first;
    first.feel = hand.servo.contact();
    first.preparation = cloud.initial;
    return first;
  }

  [[nodiscard]] session::ViewScope scope() {
    session::ViewScope scope =
        session::scope_of(cloud.scene, hand.placement.workspace.scale, {&hand.servo});
    scope.clouds = true;
    scope.spacing = cloud.source.report().spacing;
    return scope;
  }

  [[nodiscard]] ViewerControls controls() {
    ViewerControls controls;
    controls.settings = [this] {
      std::vector<Setting> list = list_settings(settings, scope());
      list.push_back(scene_setting(cloud.touched.name));
      return list;
    };
    controls.set = [this](const std::string& key, const Setting::Value& value) {
      if (key == "scene") return page.outside().open(name_of_scene(value));
      ViewSettings wanted = settings;
      set(wanted, scope(), key, value);
      apply(wanted);
    };
    controls.presets = session::preset_names();
    controls.preset = [this](const std::string& name) { apply(preset(initial, name, scope())); };
    controls.scale = [this](std::size_t) { return hand.placement.workspace.scale; };
    controls.hand = [this](std::size_t, const TargetSource::Target& target) { hand.go(target); };
    controls.release = [this](std::size_t) { hand.remote.release(); };
    return controls;
  }

  // A cloud is prepared in the next run(): of a slider that moves the last value counts.
  void apply(const ViewSettings& wanted) {
    hand.servo.set_contact(wanted.feel);
    hand.servo.set_field(wanted.field);
    settings = wanted;
  }

  void prepare() {
    try {
      cloud.prepare(settings.preparation);
    } catch (const std::exception& error) {
      settings.preparation = cloud.preparation;
      page.sessions().send_settings();
      page.warn(words_of(error, cloud.touched.name));
    }
  }

  TabCloud cloud;
  TabHand hand;
  ViewSettings initial;
  ViewSettings settings;
  TabPage page;
};

TabProgram::TabProgram(Touched touched, Outside outside, const Clock& stopwatch, std::string news)
    : parts_(std::make_unique<Parts>(std::move(touched), std::move(outside), stopwatch,
                                     std::move(news))) {}

TabProgram::~TabProgram() = default;

void TabProgram::connect(double now) {
  parts_->page.connect(now);
}

void TabProgram::receive(std::string_view text, double now) {
  parts_->hand.heard = now;
  parts_->page.receive(text, now);
}

int TabProgram::run(double now) {
  Parts& parts = *parts_;
  parts.prepare();
  if (parts.page.sessions().taken(0)) parts.hand.remote.keep_alive();
  const int steps = parts.hand.step_up_to(now);
  parts.page.tell(now);
  return steps;
}

}  // namespace palpate::tab
