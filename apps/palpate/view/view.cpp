// Connects a run with its page.
#include "apps/palpate/view/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/report/touch_report.hpp"
#include "apps/palpate/run/opening.hpp"
#include "apps/palpate/run/preparer.hpp"
#include "apps/palpate/view/address.hpp"
#include "apps/palpate/view/next_run.hpp"
#include "apps/palpate/view/page_hold.hpp"
#include "apps/palpate/view/told_progress.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/viewer/viewer.hpp"
#include "session/frames.hpp"
#include "session/view_settings.hpp"

namespace palpate::app {

namespace {

using Eigen::Vector3d;
using session::ViewScope;
using session::ViewSettings;

ViewSettings initial_settings(const Run& run) {
  ViewSettings settings;
  settings.field = run.field;
  settings.feel = {run.proxy.stiffness, run.proxy.friction, run.proxy.texture};
  const SourceOptions first = run.loaded.scene.source(0).options();
  settings.preparation.policy = first.policy.policy;
  settings.preparation.history = first.policy.history;
  settings.preparation.voxel = first.prepare.voxel;
  return settings;
}

ViewScope scope_of(const Run& run, const std::vector<Servo*>& servos) {
  double scale = 0;
  for (const Hand& hand : run.hands) scale = std::max(scale, hand.workspace.scale);
  ViewScope scope = session::scope_of(run.loaded.scene, scale, servos);
  for (const LoadedSource& source : run.loaded.sources) {
    scope.lives = scope.lives || source.camera;
    scope.depth = scope.depth || (source.camera && !source.plan.as_cloud);
    scope.clouds = scope.clouds || source.cloud || source.plan.as_cloud;
    scope.spacing = std::max(scope.spacing, source.prepared.spacing);
  }
  return scope;
}

std::vector<ViewerOptions::Stream> streams_of(const Run& run, const LiveFeed& feed) {
  std::vector<ViewerOptions::Stream> streams;
  for (StreamState& state : feed.states()) {
    ViewerOptions::Stream& stream = streams.emplace_back();
    for (std::size_t i = 0; i < run.loaded.scene.size(); ++i) {
      if (run.loaded.scene.source(i).name() != state.source) continue;
      const LoadedSource& source = run.loaded.sources[i];
      const double depth = run.loaded.scene.source(i).state().depth;
      if (source.camera && source.lens.width > 0)
        stream.frustum = session::frustum_of(source.lens, depth);
    }
    stream.state = std::move(state);
  }
  return streams;
}

// A recording has all points of a cloud.
void refuse_paged(const LoadedScene& loaded) {
  for (const LoadedSource& source : loaded.sources) {
    if (!source.paged) continue;
    throw Error(fmt::format(
        "{} is read from disk around the tools and cannot be recorded; start with a larger --cache",
        source.plan.argument.name));
  }
}

}  // namespace

// Shows pages how reading and preparing go, and what went wrong.
struct PageNews {
  // Shows what of a cloud could not be read, each thing once.
  void show_problems() {
    const std::vector<std::string> problems = feed.problems();
    for (; shown < problems.size(); ++shown) {
      viewer.notice(Viewer::NoticeLevel::warning, problems[shown]);
    }
  }

  // Around a store there is always something to come.
  void show_prepared() {
    const auto paged = [](const LoadedSource& source) { return source.paged; };
    if (std::ranges::any_of(run.loaded.sources, paged)) return;
    surface.show(viewer, "preparing the surface, first where the tools are", feed.prepared());
  }

  // Has what a page sent been prepared? Shows pages how that goes.
  bool has_opened() {
    if (run.opening == nullptr) return false;
    const std::optional<Opening::News> news = run.opening->look();
    if (!news) return false;
    if (news->kind == Opening::News::Kind::refused) {
      opened.show(viewer, news->name, 1);
      viewer.notice(Viewer::NoticeLevel::warning, news->problem);
    } else if (news->kind == Opening::News::Kind::prepares) {
      opened.show_cloud(viewer, news->name, news->share);
    } else {
      viewer.record_ended();
      viewer.restarts("the program opens " + news->name);
    }
    return news->kind == Opening::News::Kind::prepared;
  }

  const Run& run;
  const LiveFeed& feed;
  Viewer& viewer;
  std::size_t shown = 0;     // problems of the feed
  PageProgress opened = {};  // how far a file is that a page sent
  PageProgress surface = {};
};

std::deque<PageHold> holds_of(Run& run, const std::vector<Servo*>& servos) {
  std::deque<PageHold> holds;
  for (std::size_t i = 0; i < run.hands.size(); ++i) {
    holds.emplace_back(run.hands[i], run.loaded.scene, *servos[i]);
  }
  return holds;
}

struct View::Parts {
  Parts(Run& r, std::vector<Servo*> s, const LiveFeed& f, const RosBridge* b)
      : run(r),
        servos(std::move(s)),
        feed(f),
        initial(initial_settings(r)),
        settings(initial),
        next(r),
        holds(holds_of(r, servos)),
        preparer(r, initial.preparation,
                 [this](const std::string& why, const auto& held) { go_back(why, held); }),
        news{r, f, viewer},
        viewer(r.loaded.scene, servos, viewer_options(b), controls()) {
    run.recorder->on_broken([this](const std::string& why) { recording_broke(why); });
    if (run.recorder->recording().empty()) viewer.record_ended();
  }

  // These notify the viewer.
  ~Parts() {
    run.recorder->on_broken({});
    preparer.stop();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  ViewerOptions viewer_options(const RosBridge* bridge) {
    ViewerOptions options;
    const PagePlan& page = run.page;
    if (!page.address.empty()) options.address = page.address;
    options.port = page.port;
    options.listening = page.listening;
    options.token = page.token;
    options.scene = title_of(run.loaded);
    const bool picture = in_picture_axes(run.loaded);
    if (picture) options.eye = run.loaded.scene.source(0).pose().translation();
    options.up = page.up;
    if (picture && !options.up) options.up = -Vector3d::UnitY();
    options.streams = [this] { return streams_of(run, feed); };
    if (bridge != nullptr && bridge->robot())
      options.robot = [bridge] { return in_words(*bridge->robot()); };
    return options;
  }

  ViewerControls controls() {
    ViewerControls controls;
    controls.settings = [this] {
      std::vector<Setting> list = list_settings(present(), scope_of(run, servos));
      std::ranges::copy(next.settings(), std::back_inserter(list));
      return list;
    };
    controls.set = [this](const std::string& key, const Setting::Value& value) {
      if (next.set(key, value)) return;
      ViewSettings wanted = present();
      set(wanted, scope_of(run, servos), key, value);
      apply(wanted);
    };
    controls.presets = session::preset_names(run.hands.front().tool != nullptr);
    controls.preset = [this](const std::string& name) {
      apply(preset(initial, name, scope_of(run, servos)));
    };
    controls.record = [this](bool on) {
      if (on) refuse_paged(run.loaded);
      return run.recorder->record(on);
    };
    controls.recording = run.recorder->recording();
    if (run.opening != nullptr) {
      controls.open = [this](const std::string& name, std::string bytes) {
        run.opening->begin({name, Opening::Bytes{std::move(bytes)}});
      };
    }
    controls.scale = [this](std::size_t hand) { return run.hands[hand].workspace.scale; };
    controls.takeable = [this](std::size_t hand) { return holds[hand].possible(); };
    controls.hand = [this](std::size_t hand, const TargetSource::Target& target,
                           const std::optional<Vector3d>& eye) { holds[hand].move(target, eye); };
    controls.release = [this](std::size_t hand) { holds[hand].release(); };
    return controls;
  }

  [[nodiscard]] ViewSettings present() {
    const std::lock_guard lock(settings_mutex);
    return settings;
  }

  void apply(const ViewSettings& wanted) {
    check(wanted.field);  // before anything changes
    for (Servo* servo : servos) {
      servo->set_contact(wanted.feel);
      servo->set_field(wanted.field);
    }
    const std::lock_guard lock(settings_mutex);
    const bool prepares = wanted.preparation != settings.preparation;
    settings = wanted;
    if (prepares) preparer.want(settings.preparation);
  }

  // The preparer's thread.
  void go_back(const std::string& why, const ViewSettings::Preparation& held) {
    {
      const std::lock_guard lock(settings_mutex);
      settings.preparation = held;
    }
    viewer.settings_changed();
    viewer.notice(Viewer::NoticeLevel::warning, why);
  }

  [[nodiscard]] PagePlan next_page() const {
    PagePlan page = run.page;
    page.wanted = true;
    page.headless = true;
    page.port = viewer.port();
    page.listening = viewer.listening();
    page.token = token_of(viewer.url());
    page.paused = servos.front()->state().paused;
    return page;
  }

  void recording_broke(const std::string& why) {
    viewer.record_ended();
    viewer.notice(Viewer::NoticeLevel::warning, "the recording ended: " + why);
  }

  Run& run;
  std::vector<Servo*> servos;
  const LiveFeed& feed;
  ViewSettings initial;
  std::mutex settings_mutex;
  ViewSettings settings;
  NextRun next;
  std::deque<PageHold> holds;  // of each hand
  Preparer preparer;
  std::optional<Browser> browser;
  PageNews news;
  Viewer viewer;  // last: it uses all of the above
};

View::View(Run& run, std::vector<Servo*> servos, const LiveFeed& feed, const RosBridge* bridge)
    : parts_(std::make_unique<Parts>(run, std::move(servos), feed, bridge)) {
  for (Servo* servo : parts_->servos) {
    if (run.page.paused) servo->pause(true);
  }
  if (run.page.token.empty()) announce_page(parts_->viewer.url(), run.page.address);
  if (!run.page.headless) parts_->browser.emplace(parts_->viewer.url());
}

View::~View() = default;

std::optional<PagePlan> View::look() {
  for (PageHold& hold : parts_->holds) {
    if (hold.possible()) hold.keep();
  }
  parts_->news.show_problems();
  parts_->news.show_prepared();
  if (!parts_->news.has_opened()) return {};
  return parts_->next_page();
}

}  // namespace palpate::app
