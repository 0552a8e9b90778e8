// Touches a cloud with a simulated hand, and speaks the page's protocol.
#include "tab/tab_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "session/view_settings.hpp"
#include "viewer/run_view.hpp"

namespace palpate::tab {
namespace {

using session::Setting;
using session::ViewSettings;

constexpr std::string_view kSynthetic = "synthetic:";
constexpr std::array<const char*, 3> kExamples = {"rabbit", "torus", "room"};

constexpr double kStatePeriod = 1.0 / 60;  // s, as of the viewer
constexpr double kReportPeriod = 0.5;      // s, as of the viewer
constexpr double kReachingSpeed = 2;       // m/s, a fast reach of an arm, as of a program's hands
constexpr double kRiseTime = 0.3;          // s, as of a program's hands that a page may take

// A quarter of the memory that a tab may have, 2 GB: a file's bytes, its cloud and what is made of
// it are there at once.
constexpr std::size_t kLargestFile = 512 << 20;

// Nobody can be thrown by a page, and a command that is overdue counts as a release.
ServoOptions servo_options(const Placement& placement) {
  ServoOptions options;
  options.proxy.stiffness = placement.stiffness;
  options.proxy.rise_time = kRiseTime;
  options.guard.soft_start = 0;
  options.guard.silence = std::numeric_limits<double>::infinity();
  options.workspace = placement.workspace;
  return options;
}

Setting scene_setting(const std::string& present) {
  Setting setting{.key = "scene", .label = "Scene", .kind = Setting::Kind::choice};
  setting.choices.assign(kExamples.begin(), kExamples.end());
  if (!std::ranges::count(setting.choices, present)) setting.choices.push_back(present);
  setting.value = present;
  setting.restarts = true;
  return setting;
}

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

struct TabProgram::Parts {
  Parts(Touched what, Outside to, std::string say_first)
      : touched(std::move(what)),
        outside(std::move(to)),
        news(std::move(say_first)),
        source(scene.add(touched.name, touched.cloud)),
        prepared(source.options()),
        placement(place_device(scene, {}, {})),
        guide(remote, {}, {.speed = kReachingSpeed}),
        device({}, guide),
        servo(device, scene, servo_options(placement)),
        initial(initial_settings()),
        settings(initial),
        view(scene, {&servo}, viewer_options(), controls()),
        encoder(scene, view.encoding()) {}

  [[nodiscard]] ViewSettings initial_settings() const {
    ViewSettings first;
    first.feel = servo.contact();
    first.preparation.voxel = prepared.prepare.voxel;
    return first;
  }

  [[nodiscard]] session::ViewScope scope() const {
    session::ViewScope scope;
    scope.scale = placement.workspace.scale;
    scope.stiffest = std::min(kSteadyStiffness / scope.scale, servo.stiffness_limit());
    const double deepest = session::deepest_texture(scene);
    scope.deepest_texture = std::isfinite(deepest) ? deepest : 0;
    scope.clouds = true;
    scope.spacing = source.report().spacing;
    return scope;
  }

  [[nodiscard]] ViewerOptions viewer_options() const {
    ViewerOptions options;
    options.token = "tab";  // nobody else can speak to a worker
    options.scene = touched.name;
    options.limits.file = kLargestFile;
    return options;
  }

  [[nodiscard]] ViewerControls controls() {
    ViewerControls controls;
    controls.settings = [this] {
      std::vector<Setting> list = list_settings(settings, scope());
      list.push_back(scene_setting(touched.name));
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
    controls.open = [this](const std::string& name, const std::string&) { outside.open(name); };
    controls.scale = [this](std::size_t) { return placement.workspace.scale; };
    controls.hand = [this](std::size_t, TargetSource::Target target) {
      target.position = placement.workspace.position_to_device(target.position);
      remote.move(target, heard);
    };
    controls.release = [this](std::size_t) { remote.release(); };
    return controls;
  }

  void apply(const ViewSettings& wanted) {
    servo.set_contact(wanted.feel);
    servo.set_field(wanted.field);
    if (wanted.preparation != settings.preparation) prepare(wanted.preparation);
    settings = wanted;
  }

  // What could not be prepared leaves the surface as it was.
  void prepare(const ViewSettings::Preparation& wanted) {
    source.change(prepared_by(wanted, initial.preparation, prepared));
    try {
      source.set(touched.cloud);
    } catch (const std::exception&) {
      source.change(prepared_by(settings.preparation, initial.preparation, prepared));
      throw;
    }
  }

  void step(double lateness) {
    const DeviceState read = device.read();
    servo.step(read, read.time);
    device.write(servo.device_force());
    servo.show({.lateness = lateness, .computing = computing});
    ++steps;
  }

  // Clocks of browsers are too coarse for one step: the mean of all of a call counts.
  int step_up_to(double now) {
    const double rate = device.info().rate;
    const auto behind = [&] { return now - *start - static_cast<double>(steps) / rate; };
    if (behind() > kMostLate) *start += behind() - kMostLate;
    if (view.sessions().taken(0)) remote.keep_alive();
    const double begin = clock.now();
    int count = 0;
    for (; behind() >= 0; ++count) step(behind());
    if (count > 0) computing = (clock.now() - begin) / count;
    return count;
  }

  void tell(double now) {
    if (now - told >= kStatePeriod) {
      told = now;
      view.tell_states(now);
    }
    if (now - reported >= kReportPeriod) {
      reported = now;
      view.tell_faults();
    }
    const std::set<std::size_t> budgets = view.budgets();
    if (budgets.empty()) return;
    if (!news.empty()) {
      view.sessions().send({Viewer::NoticeLevel::warning, std::exchange(news, {})});
    }
    if (now < next_picture) return;
    const double begin = clock.now();
    view.show(encoder.encode(budgets));
    next_picture = now + viewer::SceneEncoder::pause_after(clock.now() - begin);
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

  Touched touched;
  Outside outside;
  std::string news;
  Scene scene;
  Source& source;
  SourceOptions prepared;  // as it was at first
  Placement placement;
  RemoteTarget remote;
  TeleoperatedHand guide;
  SimulatedDevice device;
  Servo servo;
  ViewSettings initial;
  ViewSettings settings;
  viewer::RunView view;
  viewer::SceneEncoder encoder;
  std::optional<viewer::Session> page;
  SteadyClock clock;            // of computing times alone
  std::optional<double> start;  // when the device's time was 0
  std::uint64_t steps = 0;
  double heard = 0;      // when the page said something last
  double computing = 0;  // of a step, s, in the call before
  double told = -1e300;
  double reported = -1e300;
  double next_picture = -1e300;
};

TabProgram::TabProgram(Touched touched, Outside outside, std::string news)
    : parts_(std::make_unique<Parts>(std::move(touched), std::move(outside), std::move(news))) {}

TabProgram::~TabProgram() = default;

void TabProgram::connect(double now) {
  parts_->leave();
  parts_->page.emplace(parts_->view.options().limits, now);
  parts_->view.sessions().join(*parts_->page);
}

void TabProgram::receive(std::string_view text, double now) {
  if (!parts_->page) return;
  parts_->heard = now;
  parts_->view.sessions().receive(*parts_->page, text, now);
  parts_->flush();
}

int TabProgram::run(double now) {
  if (!parts_->start) parts_->start = now;
  const int steps = parts_->step_up_to(now);
  parts_->tell(now);
  parts_->view.sessions().check(now);
  parts_->flush();
  return steps;
}

}  // namespace palpate::tab
