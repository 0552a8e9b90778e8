// Replaces view.cpp where there is no viewer.
#include "apps/palpate/view/view.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

struct View::Parts {};

View::View(Run& run, std::vector<Servo*> /*servos*/, const LiveFeed& /*feed*/,
           const RosBridge* /*bridge*/) {
  if (!run.page.wanted) return;
  throw Error("this build has no page; install libboost-dev and rebuild, or remove --view");
}
View::~View() = default;
std::optional<PagePlan> View::look() {
  return {};
}

struct WaitingPage::Parts {
  PagePlan page;
};

WaitingPage::WaitingPage(const TouchPlan& plan, std::chrono::milliseconds /*patience*/)
    : parts_(std::make_unique<Parts>(Parts{plan.page})) {}
WaitingPage::~WaitingPage() = default;
TouchPlan WaitingPage::watching(TouchPlan plan) {
  return plan;
}
PagePlan WaitingPage::end() {
  return parts_->page;
}

}  // namespace palpate::app
