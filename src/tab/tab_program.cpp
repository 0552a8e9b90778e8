// Touches a cloud with a simulated hand, and speaks the page's protocol.
#include "tab/tab_program.hpp"

#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "session/length_unit.hpp"
#include "session/view_settings.hpp"
#include "tab/tab_hand.hpp"
#include "tab/tab_page.hpp"

namespace palpate::tab {
namespace {

using session::Setting;
using session::ViewSettings;

}  // namespace

struct TabProgram::Parts {
  Parts(Touched what, Outside outside, const Clock& stopwatch, std::string news)
      : source(std::move(what)),
        hand(source.scene(), stopwatch),
        initial(initial_settings()),
        settings(initial),
        page(source.scene(), {&hand.servo}, viewer_options(), controls(), std::move(outside),
             stopwatch, std::move(news)) {}

  [[nodiscard]] ViewSettings initial_settings() const {
    ViewSettings first;
    first.feel = hand.servo.contact();
    first.preparation = source.initial();
    return first;
  }

  [[nodiscard]] session::ViewScope scope() {
    return source.scope(hand.placement.workspace.scale, {&hand.servo});
  }

  [[nodiscard]] ViewerOptions viewer_options() {
    ViewerOptions options;
    options.scene = source.name();
    options.streams = [this] { return source.streams(); };
    return options;
  }

  [[nodiscard]] ViewerControls controls() {
    ViewerControls controls;
    controls.settings = [this] {
      std::vector<Setting> list = list_settings(settings, scope());
      list.push_back(scene_setting(source.name()));
      if (source.unit()) list.push_back(*source.unit());
      return list;
    };
    controls.set = [this](const std::string& key, const Setting::Value& value) {
      if (key == "scene") return page.outside().open(name_of_scene(value));
      if (source.unit() && key == source.unit()->key) return take_unit(value);
      ViewSettings wanted = settings;
      set(wanted, scope(), key, value);
      apply(wanted);
    };
    controls.presets = session::preset_names();
    controls.preset = [this](const std::string& name) { apply(preset(initial, name, scope())); };
    controls.scale = [this](std::size_t) { return hand.placement.workspace.scale; };
    controls.hand = [this](std::size_t, const TargetSource::Target& target, const auto& eye) {
      hand.led.move(target, eye, hand.servo, hand.heard);
    };
    controls.release = [this](std::size_t) { hand.led.release(); };
    return controls;
  }

  void take_unit(const Setting::Value& value) {
    const std::optional<double> unit = session::metres_of_unit(std::get<std::string>(value));
    if (unit && value != source.unit()->value) page.outside().open_again(*unit);
  }

  // A cloud is prepared in the next run(): of a slider that moves the last value counts.
  void apply(const ViewSettings& wanted) {
    hand.servo.set_contact(wanted.feel);
    hand.servo.set_field(wanted.field);
    settings = wanted;
  }

  void prepare() {
    try {
      source.prepare(settings.preparation);
    } catch (const std::exception& error) {
      settings.preparation = source.preparation();
      page.sessions().send_settings();
      page.warn(words_of(error, source.name()));
    }
  }

  TabSource source;
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
  const int steps = parts.hand.step_up_to(now, [&](double time) { parts.source.advance(time); });
  parts.page.tell(now);
  return steps;
}

}  // namespace palpate::tab
