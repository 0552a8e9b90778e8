// Touches a cloud with a simulated hand, and speaks the page's protocol.
#include "tab/tab_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "session/view_settings.hpp"
#include "tab/tab_hand.hpp"
#include "viewer/run_view.hpp"

namespace palpate::tab {
namespace {

using session::Setting;
using session::ViewSettings;

constexpr std::string_view kSynthetic = "synthetic:";
constexpr std::array<const char*, 3> kExamples = {"rabbit", "torus", "room"};

// A quarter of the memory that a tab may have, 2 GB: a file's bytes, its cloud and what is made of
// it are there at once.
constexpr std::size_t kLargestFile = 512 << 20;

Setting scene_setting(const std::string& present) {
  Setting setting{.key = "scene", .label = "Scene", .kind = Setting::Kind::choice};
  setting.choices.assign(kExamples.begin(), kExamples.end());
  if (!std::ranges::count(setting.choices, present)) setting.choices.push_back(present);
  setting.value = present;
  setting.restarts = true;
  return setting;
}

}  // namespace

std::string words_of(const std::exception& error, const std::string& name) {
  if (dynamic_cast<const std::bad_alloc*>(&error) == nullptr) return error.what();
  return fmt::format("{} needs more memory than a tab may use; the program palpate can open it",
                     name);
}

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

// When what was done last.
struct Done {
  double states = -1e300;
  double reports = -1e300;
  double next_picture = -1e300;
};

struct TabProgram::Parts {
  Parts(Touched what, Outside to, const Clock& stopwatch, std::string say_first)
      : outside(std::move(to)),
        news(std::move(say_first)),
        cloud(std::move(what)),
        hand(cloud.scene, stopwatch),
        initial(initial_settings()),
        settings(initial),
        view(cloud.scene, {&hand.servo}, viewer_options(), controls()),
        encoder(cloud.scene, view.encoding()) {}

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

  // Nobody else can speak to a worker; what a page says while a cloud is prepared comes at once
  // afterwards, so how much it says in a second is no sign of an attack.
  [[nodiscard]] ViewerOptions viewer_options() const {
    ViewerOptions options;
    options.token = "tab";
    options.scene = cloud.touched.name;
    options.limits.file = kLargestFile;
    options.limits.messages = std::numeric_limits<int>::max();
    return options;
  }

  [[nodiscard]] ViewerControls controls() {
    ViewerControls controls;
    controls.settings = [this] {
      std::vector<Setting> list = list_settings(settings, scope());
      list.push_back(scene_setting(cloud.touched.name));
      return list;
    };
    controls.set = [this](const std::string& key, const Setting::Value& value) {
      if (key == "scene")
        return outside.open(std::string(kSynthetic) + std::get<std::string>(value));
      ViewSettings wanted = settings;
      set(wanted, scope(), key, value);
      apply(wanted);
    };
    controls.presets = session::preset_names();
    controls.preset = [this](const std::string& name) { apply(preset(initial, name, scope())); };
    // The worker opens files; this is there so that the page offers it.
    controls.open = [](const std::string&, const std::string&) {};
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
      view.sessions().send_settings();
      view.sessions().send({Viewer::NoticeLevel::warning, words_of(error, cloud.touched.name)});
    }
  }

  void tell(double now) {
    if (now - done.states >= view.kStatePeriod) {
      done.states = now;
      view.send_states(now);
    }
    if (now - done.reports >= view.kReportPeriod) {
      done.reports = now;
      view.send_faults();
    }
    const std::set<std::size_t> budgets = view.budgets();
    if (budgets.empty()) return;
    if (!news.empty()) {
      view.sessions().send({Viewer::NoticeLevel::warning, std::exchange(news, {})});
    }
    if (now < done.next_picture) return;
    const double begin = hand.clock.now();
    view.show(encoder.encode(budgets));
    done.next_picture = now + viewer::SceneEncoder::pause_after(hand.clock.now() - begin);
  }

  void flush() {
    if (!page) return;
    while (const auto message = page->outbox.take()) outside.say(*message->bytes, message->text);
    if (!page->closing) return;
    const viewer::Closing closing = *page->closing;
    leave();
    outside.close(closing.code, closing.reason);
  }

  void leave() {
    if (page) view.sessions().leave(*page);
    page.reset();
  }

  Outside outside;
  std::string news;
  TabCloud cloud;
  TabHand hand;
  ViewSettings initial;
  ViewSettings settings;
  viewer::RunView view;
  viewer::SceneEncoder encoder;
  std::optional<viewer::Session> page;
  Done done;
};

TabProgram::TabProgram(Touched touched, Outside outside, const Clock& stopwatch, std::string news)
    : parts_(std::make_unique<Parts>(std::move(touched), std::move(outside), stopwatch,
                                     std::move(news))) {}

TabProgram::~TabProgram() = default;

void TabProgram::connect(double now) {
  parts_->leave();
  parts_->page.emplace(parts_->view.options().limits, now);
  parts_->view.sessions().join(*parts_->page);
}

void TabProgram::receive(std::string_view text, double now) {
  if (!parts_->page) return;
  parts_->hand.heard = now;
  parts_->view.sessions().receive(*parts_->page, text, now);
  parts_->flush();
}

int TabProgram::run(double now) {
  Parts& parts = *parts_;
  parts.prepare();
  if (parts.view.sessions().taken(0)) parts.hand.remote.keep_alive();
  const int steps = parts.hand.step_up_to(now);
  parts.tell(now);
  parts.view.sessions().check(now);
  parts.flush();
  return steps;
}

}  // namespace palpate::tab
