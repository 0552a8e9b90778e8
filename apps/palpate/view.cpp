#include "apps/palpate/view.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <mutex>
#include <optional>
#include <utility>

#include "apps/palpate/browser.hpp"
#include "apps/palpate/log.hpp"
#include "apps/palpate/preparer.hpp"
#include "apps/palpate/touch_surface.hpp"
#include "apps/palpate/view_settings.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

namespace {

constexpr double kFar = 1.5;  // of a frustum as drawn, in medians of depth

ViewSettings initial_settings(const Run& run) {
  ViewSettings settings;
  settings.field = run.field;
  settings.feel = {run.proxy.stiffness, run.proxy.friction, run.proxy.texture};
  const SourceOptions first = run.felt.source(0).options();
  settings.policy = first.policy.policy;
  settings.history = first.policy.history;
  settings.voxel = first.prepare.voxel;
  return settings;
}

ViewScope scope_of(const Run& run) {
  ViewScope scope;
  scope.stiffest = kStiffest / run.hand.workspace.scale;
  const double deepest = deepest_texture(run.touched.scene);
  scope.deepest_texture = std::isfinite(deepest) ? deepest : 0;
  for (const TouchedSource& source : run.touched.sources) {
    scope.lives = scope.lives || source.camera;
    scope.depth = scope.depth || (source.camera && !source.as_cloud);
    scope.clouds = scope.clouds || source.cloud || source.as_cloud;
  }
  return scope;
}

std::optional<ViewerFrustum> frustum_of(const TouchedSource& source, const SourceState& state) {
  if (!source.camera) return std::nullopt;
  const CameraModel& lens = source.lens;
  return ViewerFrustum{0.5 * lens.width / lens.pinhole.fx, 0.5 * lens.height / lens.pinhole.fy,
                       kFar * state.depth};
}

std::vector<ViewerStream> streams_of(const Run& run, const LiveFeed& feed) {
  std::vector<ViewerStream> streams;
  for (StreamState& state : feed.states()) {
    ViewerStream& stream = streams.emplace_back();
    for (std::size_t i = 0; i < run.felt.size(); ++i) {
      if (run.felt.source(i).name() != state.source) continue;
      stream.frustum = frustum_of(run.touched.sources[i], run.felt.source(i).state());
    }
    stream.state = std::move(state);
  }
  return streams;
}

std::string file_name() {
  return fmt::format("palpate-{:%Y%m%d-%H%M%S}.csv", fmt::localtime(std::time(nullptr)));
}

}  // namespace

struct View::Parts {
  Parts(Run& r, Servo& s, const LiveFeed& f)
      : run(r),
        servo(s),
        feed(f),
        initial(initial_settings(r)),
        settings(initial),
        scope(scope_of(r)),
        preparer(r, initial,
                 [this](const std::string& words) { viewer.notice(NoticeLevel::warning, words); }),
        viewer(r.felt, {&s}, viewer_options(), controls()) {}

  ~Parts() { preparer.stop(); }  // what it tells, it tells the viewer
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  ViewerOptions viewer_options() {
    ViewerOptions options;
    const ViewOptions& view = run.options.view;
    if (!view.listen.empty()) options.address = view.listen;
    options.port = view.port;
    options.scene = title_of(run.touched);
    options.streams = [this] { return streams_of(run, feed); };
    return options;
  }

  ViewerControls controls() {
    ViewerControls controls;
    controls.settings = [this] { return list_settings(settings, scope); };
    controls.set = [this](const std::string& key, const SettingValue& value) {
      ViewSettings wanted = settings;
      set(wanted, key, value);
      apply(wanted, is_preparation(key));
    };
    controls.presets = preset_names();
    controls.preset = [this](const std::string& name) { apply(preset(initial, name), true); };
    controls.record = [this](bool on) { return record(on); };
    if (!run.hand.remote) return controls;
    controls.hand = [this](std::size_t, const Eigen::Vector3d& place, std::uint32_t buttons) {
      move(place, buttons);
    };
    controls.release = [this](std::size_t) { release(); };
    return controls;
  }

  void apply(const ViewSettings& wanted, bool prepares) {
    servo.set_feel(wanted.feel);
    servo.set_field(wanted.field);
    settings = wanted;
    if (prepares) preparer.want(settings);
  }

  void move(const Eigen::Vector3d& place, std::uint32_t buttons) {
    const std::lock_guard lock(hand_mutex);
    held = true;
    run.hand.remote->move({{run.hand.workspace.position_to_device(place), buttons}, clock.now()});
  }
  void release() {
    const std::lock_guard lock(hand_mutex);
    held = false;
    run.hand.remote->release();
  }
  void keep() {
    const std::lock_guard lock(hand_mutex);
    if (held) run.hand.remote->keep();
  }

  std::string record(bool on) {
    const std::lock_guard lock(log_mutex);
    if (log) log->close();
    log.reset();
    if (!on) return std::exchange(log_name, {});
    log_name = file_name();
    log.emplace(log_name);
    return log_name;
  }

  Run& run;
  Servo& servo;
  const LiveFeed& feed;
  SteadyClock clock;  // of poses
  ViewSettings initial;
  ViewSettings settings;  // the network thread's
  ViewScope scope;
  std::mutex hand_mutex;
  bool held = false;  // a page has the tool
  std::mutex log_mutex;
  std::string log_name;
  std::optional<TouchLog> log;
  Preparer preparer;
  Viewer viewer;  // last: it uses all of the above
};

View::View(Run& run, Servo& servo, const LiveFeed& feed)
    : parts_(std::make_unique<Parts>(run, servo, feed)) {
  fmt::print(stderr, "page: {}\n", parts_->viewer.url());
  if (run.options.view.open_browser) open_in_browser(parts_->viewer.url());
}

View::~View() = default;

void View::add(const TouchStep& step) {
  const std::lock_guard lock(parts_->log_mutex);
  if (parts_->log) parts_->log->add(step);
}

void View::look() {
  if (parts_->run.hand.remote) parts_->keep();
}

}  // namespace palpate::app
