// Serves a page that shows how far the clouds of a run are read.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/view/address.hpp"
#include "apps/palpate/view/told_progress.hpp"
#include "apps/palpate/view/view.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {
namespace {

std::string name_of(const TouchPlan& plan) {
  return plan.sources.empty() ? "" : plan.sources.front().argument.name;
}

}  // namespace

struct WaitingPage::Parts {
  Parts(const TouchPlan& run, std::chrono::milliseconds patience)
      : page(run.page),
        scene_name(name_of(run)),
        opens_at(std::chrono::steady_clock::now() + patience) {}

  void open() {
    ViewerOptions options;
    if (!page.address.empty()) options.address = page.address;
    options.port = page.port;
    options.listening = page.listening;
    options.scene = scene_name;
    viewer.emplace(scene, std::vector<Servo*>{}, options);
    const std::string url = viewer->url();
    announce_page(url, page.address);
    if (!page.headless) browser.emplace(url);
    page.headless = true;
    page.port = viewer->port();
    page.listening = viewer->listening();
    page.token = token_of(url);
  }

  void show(const std::string& name, double share) {
    if (!page.served || std::chrono::steady_clock::now() < opens_at) return;
    if (!viewer) open();
    progress.show_cloud(*viewer, name, share);
  }

  PagePlan page;
  std::string scene_name;
  std::chrono::steady_clock::time_point opens_at;
  Scene scene;  // without a source yet
  PageProgress progress;
  std::optional<Browser> browser;
  std::optional<Viewer> viewer;  // last: it uses the scene
};

WaitingPage::WaitingPage(const TouchPlan& plan, std::chrono::milliseconds patience)
    : parts_(std::make_unique<Parts>(plan, patience)) {}

WaitingPage::~WaitingPage() = default;

TouchPlan WaitingPage::watching(TouchPlan plan) {
  for (SourcePlan& source : plan.sources) {
    source.reading.progress = [parts = parts_.get(), name = source.argument.name](double share) {
      parts->show(name, share);
    };
  }
  return plan;
}

PagePlan WaitingPage::end() {
  if (parts_->viewer) parts_->viewer->restarts("the run begins");
  parts_->viewer.reset();
  return parts_->page;
}

}  // namespace palpate::app
